// SPDX-License-Identifier: Apache-2.0
#include "scene_io/machine_rules.h"

#include <algorithm>

#include "scene_io/bucket_reader.h"
#include "scene_io/mechanism_reader.h"

namespace navvy::scene_io {

namespace {

using JointType = scene::Joint::Type;

/// Returns the SDF type of a joint by its name; empty for an unknown joint.
/// The XML still distinguishes continuous from revolute joints, which scene::Joint does not.
std::string type_of(const Names& names, const std::string& joint) {
  const auto type = names.joint_type.find(joint);
  return type == names.joint_type.end() ? "" : type->second;
}

/// Checks a cylinder. A rod as thick as the bore would leave the oil no area to retract it.
void check_cylinder(const Element& element, const scene::Cylinder& cylinder, Faults& faults) {
  if (has(element, "rod_pin_m") == has(element, "linkage"))
    faults.error(element, "",
                 "needs either <rod_pin_m> (acts directly) or <linkage> (acts through a rocker)",
                 "give one of them");
  if (cylinder.rod >= cylinder.bore)
    faults.error(element, "", "rod_m must be less than bore_m",
                 "give diameters: the rod runs inside the bore");
  if (cylinder.base_link == cylinder.rod_link && !cylinder.base_link.empty())
    faults.error(element, cylinder.rod_link, "base_link and rod_link must be different links",
                 "name the links at the two ends of the cylinder");
}

void check_encoder(const Element& element, std::size_t index, const Names& names,
                   const scene::Machine& machine, Faults& faults) {
  const std::string& name = machine.encoders[index].joint;
  const std::string type = type_of(names, name);
  // Unknown names have been reported.
  if (type.empty()) return;
  const Element& at = child_or_self(element, "joint");
  if (type != "revolute" && type != "continuous")
    faults.error(at, type, "an encoder counts the turns of a joint that turns",
                 "name a revolute or continuous joint");
  // Only earlier ones are compared, so that a pair is reported once, at the second encoder.
  for (std::size_t i = 0; i < index; ++i)
    if (machine.encoders[i].joint == name)
      faults.error(at, name, "this joint has an encoder already", "remove one of them");
}

void check_levers(const Element& element, const scene::Machine& machine, Faults& faults) {
  const scene::Arm& arm = machine.arm;
  if (arm.swing.empty() && arm.boom.empty() && arm.stick.empty() && arm.bucket.empty())
    faults.error(element, "", "levers move an arm, and the machine names none",
                 "add <navvy:arm> with the joints' roles");
  // A lever commands a share of the top speed.
  for (const std::string& name : {arm.swing, arm.boom, arm.stick, arm.bucket}) {
    const int joint = machine.joint_index(name);
    // 1e8 is far below the default of `velocity`, 1e9, which stands for no limit.
    if (joint < 0 || machine.joints[static_cast<std::size_t>(joint)].velocity < 1e8) continue;
    if (std::none_of(machine.cylinders.begin(), machine.cylinders.end(),
                     [&](const scene::Cylinder& c) { return c.joint == name; }))
      faults.error(element, name,
                   "a lever commands a share of a joint's speed, and this joint's has no limit",
                   "give it a <navvy:cylinder>, or a <velocity> in the <limit> of its <axis>");
  }
}

/// A bed is a shell on its own link, which its joint tips.
void check_bed(const Element& element, std::size_t index, const Names& names,
               const scene::Machine& machine, Faults& faults) {
  const scene::Bed& bed = machine.beds[index];
  const std::string type = type_of(names, bed.joint);
  if (!type.empty() && type != "revolute")
    faults.error(child_or_self(element, "joint"), type, "a bed tips on a revolute joint",
                 "name the joint of its hinge");
  if (index > 0)
    faults.error(element, "", "a machine has one bed", "make the second one a machine of its own");
  // The shell is looked up in the list, as the reader has checked its name only.
  for (const scene::Shell& shell : machine.shells)
    if (shell.name == bed.shell && shell.link != bed.link)
      faults.error(element, bed.link,
                   "its shell '" + bed.shell + "' is on link '" + shell.link + "'",
                   "name the link of the shell");
  const int joint = machine.joint_index(bed.joint);
  if (joint < 0) return;
  const int child = machine.joints[static_cast<std::size_t>(joint)].child;
  const std::string tipped = child < 0 ? "" : machine.links[static_cast<std::size_t>(child)].name;
  if (tipped != bed.link)
    faults.error(element, bed.joint, "the joint moves link '" + tipped + "', not the bed's",
                 "name the joint that tips it");
}

/// A plane carries whatever rests on it, everywhere: only the rock under the ground can be one.
void check_planes(const Element& model, const scene::Machine& machine, Faults& faults) {
  for (std::size_t l = 0; l < machine.links.size(); ++l)
    for (const scene::Collision& collision : machine.links[l].collisions) {
      if (collision.geometry.kind != scene::Geometry::Kind::kPlane) continue;
      const Element* link = named_child(model, "link", machine.links[l].name);
      if (l > 0 || !machine.fixed_base)
        faults.error(link ? *link : model, collision.name,
                     "a plane cannot move: it is the rock under the ground",
                     "use a <box>, or make the model <static>true</static>");
    }
}

/// Ball joints have no <axis>, and SDF has no limits for them, so the cone and twist are
/// extensions.
void check_ball(const Element& joint, const Element& element, Faults& faults) {
  if (attribute(joint, "type") != "ball")
    faults.error(element, attribute(joint, "type"), "only a ball joint has a cone and a twist",
                 "give limits in its <axis>");
  else if (!has(element, "cone_deg") && !has(element, "twist_deg"))
    faults.error(element, "", "needs <cone_deg>, <twist_deg> or both",
                 "remove it for a ball that turns freely");
}

/// Brakes hold joints that turn or slide; the drive brakes joints that spin wheels.
void check_brake(const Element& joint, const Element& element, const scene::Machine& machine,
                 Faults& faults) {
  const std::string name = attribute(joint, "name");
  const int index = machine.joint_index(name);
  if (index < 0) return;
  const JointType type = machine.joints[static_cast<std::size_t>(index)].type;
  const bool turns = type == JointType::kRevolute;
  if (!turns && type != JointType::kPrismatic)
    faults.error(element, attribute(joint, "type"), "a brake holds a joint that turns or slides",
                 "remove it");
  else if (has(element, "torque_nm") != turns || has(element, "force_n") == turns)
    faults.error(element, "",
                 turns ? "a revolute joint needs <torque_nm>" : "a prismatic joint needs <force_n>",
                 "the most that the brake holds");
  for (const scene::Wheel& wheel : machine.wheels)
    if (wheel.joint == name)
      faults.error(
          element, name, "this joint spins a wheel, which the drive brakes",
          "remove it; brake_force_n of <navvy:drive> and the input drive/brake hold wheels");
}

void check_joint_extensions(Element& model, const scene::Machine& machine, Faults& faults) {
  for (const Element* joint : children_of(model, {"joint"})) {
    if (const Element* ball = joint->FirstChildElement("navvy:ball"))
      check_ball(*joint, *ball, faults);
    if (const Element* brake = joint->FirstChildElement("navvy:brake"))
      check_brake(*joint, *brake, machine, faults);
  }
}

/// A material of two words would be split where a table of pairs names it.
void check_materials_of_links(const Element& model, const scene::Machine& machine, Faults& faults) {
  for (const scene::Link& link : machine.links) {
    const Element* element = named_child(model, "link", link.name);
    const Element* material = element ? element->FirstChildElement("navvy:material") : nullptr;
    if (material != nullptr && words_of(link.material.name).size() > 1)
      faults.error(*material, link.material.name, "must be one word", "e.g. steel");
  }
}

}  // namespace

void check_extensions(Element& model, const Names& names, const scene::Machine& machine,
                      Faults& faults) {
  // The reader has appended an item for every element, faulty ones too, so the i-th item belongs to
  // the i-th element.
  std::size_t i = 0;
  for (const Element* e : children_of(model, {"navvy:cylinder"}))
    check_cylinder(*e, machine.cylinders.at(i++), faults);
  i = 0;
  for (const Element* e : children_of(model, {"navvy:encoder"}))
    check_encoder(*e, i++, names, machine, faults);
  i = 0;
  for (const Element* e : children_of(model, {"navvy:bed"}))
    check_bed(*e, i++, names, machine, faults);
  i = 0;
  for (const Element* e : children_of(model, {"navvy:bucket"}))
    check_teeth(*e, machine.buckets.at(i++), faults);
  if (const Element* e = model.FirstChildElement("navvy:levers")) check_levers(*e, machine, faults);
  if (const Element* e = model.FirstChildElement("navvy:pump")) {
    if (machine.cylinders.empty())
      faults.error(*e, "", "a pump needs cylinders to feed",
                   "add <navvy:cylinder>, or remove the pump");
    // This is a warning, as a scene may switch one machine between both kinds of physics.
    if (machine.kinematic)
      faults.warning(*e, "", "a kinematic machine moves as commanded and does not use a pump",
                     "remove it");
  }
  if (const Element* e = model.FirstChildElement("navvy:drive"); e && machine.wheels.empty())
    faults.error(*e, "", "a drive needs wheels",
                 "add <navvy:wheel> with <driven>true</driven>, or <navvy:track>");
  check_joint_extensions(model, machine, faults);
  check_materials_of_links(model, machine, faults);
  check_planes(model, machine, faults);
}

void set_initial_positions(Element& parent, const std::vector<scene::InitialPosition>& positions,
                           scene::Machine& machine, Faults& faults) {
  if (machine.links.empty()) return;
  // `positions` has one entry for each of these elements, in their order.
  const std::vector<Element*> elements = children_of(parent, {"navvy:joint"});
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const scene::InitialPosition& start = positions[i];
    const Element& element = *elements.at(i);
    if (start.has_angle == start.has_length) {
      faults.error(element, "", "needs either <initial_deg> or <initial_m>");
      continue;
    }
    if (!require_name(element, start.joint, "joint of this name in the machine",
                      names_in_list(machine.joints), faults))
      continue;
    scene::Joint& joint =
        machine.joints[static_cast<std::size_t>(machine.joint_index(start.joint))];
    const bool turns = joint.type == JointType::kRevolute;
    if (!turns && joint.type != JointType::kPrismatic)
      faults.error(element, start.joint, "only revolute and prismatic joints have a position",
                   "remove it, or name another joint");
    else if (turns != start.has_angle)
      faults.error(
          element, start.joint,
          turns ? "a revolute joint needs <initial_deg>" : "a prismatic joint needs <initial_m>");
    joint.initial = turns ? start.angle : start.length;
    // 1e-9 allows for rounding: limits are written in radians, positions often in degrees.
    if (joint.has_limits &&
        (joint.initial < joint.lower - 1e-9 || joint.initial > joint.upper + 1e-9))
      faults.error(element, text_of(*element.FirstChildElement()),
                   "must be within the limits of the joint");
  }
  close_at_start(parent, positions, machine, faults);
}

}  // namespace navvy::scene_io
