// SPDX-License-Identifier: Apache-2.0
#include "scene_io/channel_reader.h"

#include <algorithm>

#include "scene_io/fields.h"

namespace navvy::scene_io {

void read_encoder(Element& element, const Names& names, scene::Machine& machine, Faults& faults) {
  scene::Encoder encoder;
  Fields(element, faults)
      .text("joint", encoder.joint)
      .required("joint")
      .number("counts_per_turn", encoder.counts_per_turn, {1, 1e7})
      .required("counts_per_turn")
      .whole("bits", encoder.bits, {2, 32})
      // Beyond, a wheel would turn ten times as far as it rolls.
      .number("slip", encoder.slip, {-0.9, 0.9})
      .number("missed", encoder.missed, {0, 1})
      .finish();
  require_name(element, "joint", "joint", names.joints, faults);
  const Element* joint = element.FirstChildElement("joint");
  const auto type = names.joint_type.find(encoder.joint);
  // Unknown names have been told.
  if (joint == nullptr || type == names.joint_type.end()) return;
  if (type->second != "revolute" && type->second != "continuous")
    faults.error(*joint, type->second, "an encoder counts the turns of a joint that turns",
                 "name a revolute or continuous joint");
  for (const scene::Encoder& other : machine.encoders)
    if (other.joint == encoder.joint)
      faults.error(*joint, encoder.joint, "this joint has an encoder already",
                   "take one of them out");
  machine.encoders.push_back(std::move(encoder));
}

void read_levers(Element& element, scene::Machine& machine, Faults& faults) {
  using Pattern = scene::Levers::Pattern;
  machine.levers.given = true;
  Fields(element, faults)
      .choice("pattern", machine.levers.pattern, {{"iso", Pattern::kIso}, {"sae", Pattern::kSae}})
      .number("dead_band", machine.levers.dead_band, {0, 0.5})
      .finish();
  const scene::Arm& arm = machine.arm;
  if (arm.swing.empty() && arm.boom.empty() && arm.stick.empty() && arm.bucket.empty())
    faults.error(element, "", "levers move an arm, and the machine names none",
                 "add <navvy:arm> with the joints' roles");
  // A lever asks for a share of the fastest.
  for (const std::string& name : {arm.swing, arm.boom, arm.stick, arm.bucket}) {
    const int joint = machine.joint_index(name);
    if (joint < 0 || machine.joints[static_cast<std::size_t>(joint)].velocity < 1e8) continue;
    const bool has_cylinder =
        std::any_of(machine.cylinders.begin(), machine.cylinders.end(),
                    [&](const scene::Cylinder& c) { return c.joint == name; });
    if (!has_cylinder)
      faults.error(element, name,
                   "a lever asks for a share of a joint's speed, and this joint's has no limit",
                   "give it a <navvy:cylinder>, or a <velocity> in the <limit> of its <axis>");
  }
}

}  // namespace navvy::scene_io
