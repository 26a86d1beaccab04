// SPDX-License-Identifier: Apache-2.0
#include "scene_io/machine_reader.h"

#include "scene_io/assembly.h"
#include "scene_io/bucket_reader.h"
#include "scene_io/derived_parts.h"
#include "scene_io/drive_rules.h"
#include "scene_io/found_wheels.h"
#include "scene_io/link_rules.h"
#include "scene_io/machine_rules.h"
#include "scene_io/mechanism_reader.h"
#include "scene_io/sdf_model.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/sensor_reader.h"
#include "scene_io/shell_reader.h"

namespace navvy::scene_io {

void read_extensions(Element& model, const Names& names, scene::Machine& machine, Faults& faults) {
  ElementReader reader(model, &names, faults, true);
  machine.describe(reader);
  std::size_t i = 0;
  for (Element* e : children_of(model, {"navvy:shell"}))
    finish_shell(*e, machine.shells.at(i++), faults);
  Element* drive = model.FirstChildElement("navvy:drive");
  if (drive != nullptr) finish_drive(*drive, machine.drive, faults);
  finish_mechanisms(model, machine, faults);
  set_initial_positions(model, machine.initial_positions, machine, faults);
  finish_tracks(model, machine, faults);
  check_extensions(model, names, machine, faults);
  if (drive != nullptr && !machine.links.empty() && !machine.wheels.empty())
    check_wheels(*drive, machine, faults);
}

namespace {

/// Warns of a foreign machine whose wheels are rigid bodies to the soil.
void warn_of_rigid_wheels(const Element& model, const scene::Machine& machine, Faults& faults) {
  if (!Document::of(model).foreign() || !machine.wheels.empty() || faults.has_errors()) return;
  if (const std::size_t wheels = find_wheels(machine).size(); wheels > 0)
    faults.warning(model, std::to_string(wheels) + " wheels",
                   "roll as rigid bodies, which neither sink into soil nor leave ruts",
                   "`navvy import FILE --out DIR` gives them tyres and a drive");
}

}  // namespace

scene::Machine read_machine(Element& model, bool sdf_sound, Faults& faults) {
  scene::Machine machine;
  machine.file = Document::of(model).file();
  machine.name = attribute(model, "name");
  const Names names = Names::of_model(model);
  if (model.Attribute("placement_frame"))
    faults.error(model, attribute(model, "placement_frame"), "placement_frame is not supported",
                 "remove it");
  for (Element* bucket : children_of(model, {"navvy:bucket"})) fill_in_bucket(*bucket, faults);
  const bool kinematic = child_text(model, "navvy:physics") == "kinematic";
  const std::size_t before = faults.error_count();
  check_links(model, !kinematic && !is_true(child_text(model, "static")), faults);
  check_joints(model, names, faults);
  std::vector<Gearbox> gearboxes;
  if (sdf_sound && faults.error_count() == before &&
      read_sdf_model(model, machine, gearboxes, faults))
    read_gears(model, gearboxes, machine, faults);
  for (scene::Link& link : machine.links)
    if (const Element* element = named_child(model, "link", link.name))
      link.material.line = place_of(child_or_self(*element, "navvy:material")).line;
  read_extensions(model, names, machine, faults);
  read_sensors(model, names, machine, faults);
  make_buckets(model, machine, faults);
  // Wheels and shells decide which links have other contact shapes.
  derive_parts(model, machine, faults);
  warn_of_rigid_wheels(model, machine, faults);
  return machine;
}

scene::Machine read_machine_file(const std::string& file, Faults& faults) {
  const auto document = Document::open(file, faults);
  if (!document || !check_root(*document->root(), faults)) return {};
  Element& root = *document->root();
  // Faults of other files that were read before do not stop this one from being read.
  const std::size_t before = faults.error_count();
  // After a fault in a part, the whole would report it again.
  if (!assemble(*document, faults)) return {};
  check_sdf(root, faults);
  Element* model = root.FirstChildElement("model");
  if (!model) {
    const Element* world = root.FirstChildElement("world");
    faults.error(root, world != nullptr ? attribute(*world, "name") : "",
                 "a machine file needs a <model>",
                 world != nullptr ? "this one holds a world, which cannot be included: name the "
                                    "file of a machine"
                                  : "add it, or name the file of a machine");
    return {};
  }
  // A machine file is used in many worlds.
  for (const char* name : {"navvy:program", "navvy:on_ground", "navvy:load"})
    if (Element* e = model->FirstChildElement(name))
      faults.error(*e, "", "belongs to the world that uses the machine", "move it into <include>");
  return read_machine(*model, faults.error_count() == before, faults);
}

}  // namespace navvy::scene_io
