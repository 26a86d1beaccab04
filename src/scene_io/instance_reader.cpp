// SPDX-License-Identifier: Apache-2.0
#include "scene_io/instance_reader.h"

#include <cmath>
#include <filesystem>

#include "core/limits.h"
#include "scene_io/bucket_reader.h"
#include "scene_io/machine_reader.h"
#include "scene_io/machine_rules.h"
#include "scene_io/mesh_path.h"
#include "scene_io/program_reader.h"
#include "scene_io/sensor_reader.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {

namespace {

/// Returns the machine of a file, which is read at its first use.
const scene::Machine& machine_of(const std::string& path, const Known& known, Faults& faults) {
  const auto [at, is_new] = known.files.try_emplace(path);
  MachineFile& file = at->second;
  const std::size_t before = faults.work.elements;
  if (is_new) {
    file.machine = read_machine_file(path, faults);
    file.elements = faults.work.elements - before;
  } else {
    // A copy costs less than reading, but the scene that is written out holds them all.
    faults.work.elements += file.elements;
  }
  return file.machine;
}

void check_load(const Element& element, const scene::MachineInWorld& instance,
                const scene::Scene& world, Faults& faults) {
  const scene::Machine& machine = instance.machine;
  // A machine without links has faults of its own.
  if (!machine.links.empty() && machine.beds.empty())
    faults.error(element, instance.name, "only a machine with <navvy:bed> carries a load",
                 "remove the load, or place a machine with a bed, as dumper");
  const int index = world.soil_index(instance.load.soil);
  if (index < 0 || machine.beds.empty()) return;
  const scene::Soil& soil = world.soils[static_cast<std::size_t>(index)];
  // Loose soil has the bank density divided by the swell.
  const double struck = machine.beds[0].capacity * soil.bank_density / soil.swell;
  if (instance.load.mass > struck)
    faults.warning(element, child_text(element, "mass_kg"),
                   "more than the bed holds struck, " + std::to_string(std::lround(struck)) +
                       " kg of loose '" + soil.name + "'",
                   "the heap above the rim may fall off");
}

void read_place(const Element& pose, scene::MachineInWorld& instance, const scene::Scene& world,
                const Known& known, Faults& faults) {
  // check_sdf reports a pose that is too short.
  if (words_of(text_of(pose)).size() >= 6) read_pose(pose, instance.X_WM, faults);
  if (pose.Attribute("relative_to"))
    faults.error(pose, attribute(pose, "relative_to"), "relative_to is not supported here",
                 "give the pose in the world");
  const Vec2 place = instance.X_WM.translation().head<2>();
  const Vec2 low = world.ground.origin, high = low + world.ground.size;
  // Places are compared only with ground that was read without faults.
  if (known.ground && ((place.array() < low.array()).any() || (place.array() > high.array()).any()))
    faults.error(pose, text_of(pose), "the machine must stand on the site",
                 "move it, or enlarge size_m of the ground");
}

/// Reports an <include> that names the world it stands in.
bool check_no_loop(const Element& uri, const std::string& path, Faults& faults) {
  std::error_code ignored;
  const std::string& own = Document::of(uri).file();
  if (!std::filesystem::equivalent(path, own, ignored)) return true;
  // A scene around a machine alone has the name of the machine's file.
  Faults unread;
  const auto document = Document::open(path, unread);
  if (!document || document->root()->FirstChildElement("model") != nullptr) return true;
  faults.error(uri, text_of(uri), "a world cannot be a part of itself",
               "name the file of a machine, or remove the <include>");
  return false;
}

/// Reads the machine of an <include> from its file.
void read_include(Element& element, scene::MachineInWorld& instance, const Known& known,
                  Faults& faults) {
  Element* uri = element.FirstChildElement("uri");
  std::string path;
  if (uri == nullptr) {
    faults.error(element, "", "needs an element <uri>", "e.g. <uri>model://ew180</uri>");
  } else if (!text_of(*uri).empty() && resolve_model(*uri, path, faults) &&
             check_no_loop(*uri, path, faults)) {
    if (faults.work.elements > limits::kSceneElements)
      faults.error(element, text_of(*uri),
                   "a scene and its machines may have at most " +
                       std::to_string(limits::kSceneElements) + " elements together",
                   "use fewer or simpler machines");
    else
      instance.machine = machine_of(path, known, faults);
  }
  // Without a <name> a machine has the name of its model.
  const Element* name = element.FirstChildElement("name");
  instance.name = name != nullptr ? text_of(*name) : instance.machine.name;
  if (name != nullptr) check_name(*name, instance.name, faults);
  if (is_true(child_text(element, "static"))) instance.machine.fixed_base = true;
}

}  // namespace

scene::MachineInWorld read_instance(Element& element, const scene::Scene& world, const Known& known,
                                    Faults& faults) {
  scene::MachineInWorld instance;
  const bool is_include = std::string(element.Name()) == "include";
  instance.in_scene = !is_include;
  Names names;
  if (is_include) {
    read_include(element, instance, known, faults);
  } else {
    instance.machine = read_machine(element, known.sdf_sound, faults);
    instance.name = instance.machine.name;
  }
  // Sensors of the scene name parts of the machine.
  names.links = names_in_list(instance.machine.links);
  names.joints = names_in_list(instance.machine.joints);
  names.shells = names_in_list(instance.machine.shells);
  for (Element* sensor : children_of(element, {"navvy:sensor"})) fill_in_preset(*sensor, faults);
  Element* bucket = is_include ? element.FirstChildElement("navvy:bucket") : nullptr;
  if (bucket != nullptr) fill_in_bucket(*bucket, faults);
  names.soils = names_in_list(world.soils);
  if (!names.soils.empty()) instance.load.soil = names.soils[0];
  const bool kinematic_file = is_include && instance.machine.kinematic;
  // An <include> has fields of its own beside those of the machine; a <model> was read above.
  ElementReader reader(element, &names, faults, true);
  instance.describe_instance(reader);
  if (bucket != nullptr && instance.bucket)
    fit_bucket(*bucket, *instance.bucket, instance.machine, faults);
  if (const Element* physics = element.FirstChildElement("navvy:physics");
      kinematic_file && physics != nullptr && !instance.machine.kinematic) {
    faults.error(*physics, text_of(*physics),
                 "the machine's own file says kinematic: its links need no masses",
                 "set <navvy:physics>dynamic</navvy:physics> in " + instance.machine.file);
    instance.machine.kinematic = true;
  }
  set_initial_positions(element, instance.initial_positions, instance.machine, faults);
  add_sensors(element, instance, faults);
  if (const Element* pose = element.FirstChildElement("pose"))
    read_place(*pose, instance, world, known, faults);
  if (const Element* load = element.FirstChildElement("navvy:load"))
    check_load(*load, instance, world, faults);
  if (Element* program = element.FirstChildElement("navvy:program"))
    instance.program = read_program(*program, known.kinds, &instance.machine,
                                    known.ground ? &world.ground : nullptr, faults);
  return instance;
}

}  // namespace navvy::scene_io
