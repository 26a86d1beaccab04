// SPDX-License-Identifier: Apache-2.0
#include "scene_io/world_reader.h"

#include <algorithm>
#include <limits>
#include <map>

#include "core/edit_distance.h"
#include "core/limits.h"
#include "geometry/pieces.h"
#include "scene/overlay.h"
#include "scene/soil_values.h"
#include "scene_io/assembly.h"
#include "scene_io/design_reader.h"
#include "scene_io/element_reader.h"
#include "scene_io/forbidden_reader.h"
#include "scene_io/ground_reader.h"
#include "scene_io/hitch_reader.h"
#include "scene_io/instance_reader.h"
#include "scene_io/materials_reader.h"
#include "scene_io/program_order.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/soil_reader.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {

namespace {

/// Reads a section of a world that stands by itself, if the world has it.
template <class T>
void read_section(Element& world, const char* name, T& into, Faults& faults) {
  if (Element* e = world.FirstChildElement(name)) read_element(*e, into, nullptr, faults);
}

/// Names of scenes, cameras and maps become names of files and folders, which people hand on to
/// shells. check_name refuses other characters that no name may hold.
void require_file_name(const Element& element, const std::string& name, Faults& faults) {
  const bool plain =
      // A leading dot would hide the folder, a trailing blank cannot be seen.
      name.empty() || (name.front() != '.' && name.back() != ' ' &&
                       name.find_first_of("/\\~$`'(){}[]<>|&;*?!#%") == std::string::npos);
  if (!plain)
    faults.error(element, name,
                 "files and folders of results are named after it: no '.' at its start, no blank "
                 "at its end, no '/' and no character that a shell interprets",
                 "use letters, digits, _ and -");
}

/// Reports an object with the name of an earlier one of its kind.
template <class T>
void require_new_name(const Element& at, const std::string& name, const char* kind,
                      const std::vector<T>& others, const char* remedy, Faults& faults) {
  for (const T& other : others)
    if (!name.empty() && other.name == name)
      faults.error(at, name, std::string("there is already a ") + kind + " of this name", remedy);
}

/// Reads goals of the score; those about the shape of the ground need a design.
void read_goals(Element& world_element, scene::Scene& world, Faults& faults) {
  Element* e = world_element.FirstChildElement("navvy:goals");
  if (e == nullptr) return;
  const std::size_t before = faults.error_count();
  read_element(*e, world.goals, nullptr, faults);
  if (faults.error_count() > before) return;
  if (!world.goals.any())
    faults.warning(*e, "", "sets no goal", "add one, such as <completion>0.95</completion>");
  else if (world.goals.need_design() && !world.commanded_design().any())
    faults.error(*e, "", "goals of the shape need a shape",
                 "add a <navvy:design>, or a dig_area or grade to a program");
}

/// Reads records. The code that writes maps knows formats and layers; it checks them with the line.
void read_records(Element& world_element, scene::Scene& world, Faults& faults) {
  for (Element* e : children_of(world_element, {"navvy:record"})) {
    scene::MapRecord record;
    record.line = e->GetLineNum();
    read_element(*e, record, nullptr, faults);
    record.layers = words_of(record.layer_names);
    require_file_name(*e, record.name, faults);
    require_new_name(*e, record.name, "record", world.records, "rename one of them", faults);
    world.records.push_back(std::move(record));
  }
}

/// Checks the machine and link that a camera names.
void check_camera_names(const Element& element, const scene::Camera& camera,
                        const scene::Scene& world, Faults& faults) {
  if (camera.machine.empty()) return;
  if (!require_name(child_or_self(element, "machine"), camera.machine,
                    "machine of this name in the world", names_in_list(world.machines), faults))
    return;
  const int index = world.machine_index(camera.machine);
  const scene::Machine& machine = world.machines[static_cast<std::size_t>(index)].machine;
  // A machine without links has faults of its own, which have been reported.
  if (!camera.link.empty() && !machine.links.empty())
    require_name(child_or_self(element, "link"), camera.link, "link of this name in the machine",
                 names_in_list(machine.links), faults);
}

void read_cameras(Element& world_element, scene::Scene& world, Faults& faults) {
  using Kind = scene::Camera::Kind;
  for (Element* e : children_of(world_element, {"navvy:camera"})) {
    scene::Camera camera;
    read_element(*e, camera, nullptr, faults);
    require_file_name(*e, camera.name, faults);
    // The frame of the two points follows from the names: none, a machine, or a link of it.
    if (!camera.machine.empty()) camera.kind = camera.link.empty() ? Kind::kChase : Kind::kOnLink;
    if (camera.machine.empty() && !camera.link.empty())
      faults.error(*e, camera.link, "a camera on a link needs <machine>, too",
                   "name the machine in <machine>");
    if (!camera.link.empty() && camera.frame != scene::Camera::Framed::kNothing)
      faults.error(child_or_self(*e, "frame"), "", "a camera on a link frames nothing",
                   "remove <frame> or <link>");
    // A camera needs a direction to look in.
    if ((camera.position - camera.target).norm() < 1e-3)
      faults.error(*e, "", "position_m and target_m must not be the same place",
                   "move one of them: the camera looks from position_m at target_m");
    check_camera_names(*e, camera, world, faults);
    require_new_name(*e, camera.name, "camera", world.cameras, "rename one of them", faults);
    world.cameras.push_back(std::move(camera));
  }
}

/// Reads the names of overlays.
void read_overlays(Element& world_element, scene::Scene& world, Faults& faults) {
  Element* e = world_element.FirstChildElement("navvy:show");
  if (e == nullptr) return;
  world.show = text_of(*e);
  std::vector<std::string> known;
  for (const scene::OverlayInfo& one : scene::overlays()) known.push_back(one.name);
  std::string color;
  for (const std::string& word : words_of(world.show)) {
    const scene::OverlayInfo* one = scene::overlay_named(word);
    if (one == nullptr) {
      faults.error(*e, word, "is no overlay", suggestion(word, known));
    } else if (one->color && !color.empty() && color != word) {
      faults.error(*e, word, "soil has one color, and '" + color + "' sets it already",
                   "remove one of the two");
    } else if (one->color) {
      color = word;
    }
  }
}

void read_light(Element& element, std::vector<scene::Light>& lights, Faults& faults) {
  if (attribute(element, "type") != "directional") {
    // Pictures have no point or spot lights.
    faults.warning(element, attribute(element, "type"), "is ignored",
                   "only directional lights are drawn");
    return;
  }
  scene::Light light;
  std::vector<double> v;
  Faults seen;  // check_sdf has reported them
  if (Element* e = element.FirstChildElement("direction"); e && read_numbers(*e, 3, {}, v, seen)) {
    light.direction = Vec3(v[0], v[1], v[2]);
    if (light.direction.norm() < 1e-9)
      faults.error(*e, text_of(*e), "a direction must not be zero");
    else
      light.direction.normalize();
  }
  if (Element* e = element.FirstChildElement("diffuse")) {
    // Alpha may be left out; check_sdf has reported what is no number.
    // Such a component stays 1.
    const auto words = words_of(text_of(*e));
    double c[4] = {1, 1, 1, 1};
    for (std::size_t i = 0; i < 4 && i < words.size(); ++i) to_number(words[i], c[i]);
    light.color = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]),
                   static_cast<float>(c[3])};
  }
  lights.push_back(light);
}

void read_soils(Element& world_element, scene::Scene& world, Faults& faults) {
  for (Element* e : children_of(world_element, {"navvy:soil"})) {
    scene::Soil soil = read_soil(*e, faults);
    require_new_name(*e, soil.name, "soil", world.soils, "give this one another name=\"...\"",
                     faults);
    world.soils.push_back(std::move(soil));
  }
  if (world.soils.empty())
    faults.error(world_element, "", "a world needs a soil", "add <navvy:soil ref=\"loam\"/>");
}

void check_grid(const Element& world_element, const scene::Scene& world, Faults& faults) {
  const Vec2 cells = world.ground.size / world.solver.cell;
  const Element* ground = world_element.FirstChildElement("navvy:ground");
  const Element& at = ground ? *ground : world_element;
  if (cells.minCoeff() < 4)
    faults.error(at, "", "the site must be at least 4 cells wide",
                 "smaller cell_m or larger size_m");
  // The sparse tables index columns with 16 bits.
  if (cells.maxCoeff() > 65536)
    faults.error(at, "", "the site must be at most 65536 cells wide",
                 "larger cell_m or smaller size_m");
}

/// Checks limits that depend on the cell: mass of a particle, pieces of shells.
void check_cell(const Element& world_element, const scene::Scene& world, Faults& faults) {
  const Element* solver = world_element.FirstChildElement("navvy:solver");
  const Element& at = solver ? *solver : world_element;
  const double cell = world.solver.cell;
  for (const scene::Soil& soil : world.soils)
    // A particle holds its mass as a 32-bit count of kMassQuantum: 2^31 * 2^-24 kg = 128 kg.
    if (scene::heaviest_particle(soil, cell) / kMassQuantum >
        std::numeric_limits<std::int32_t>::max())
      faults.error(at, std::to_string(cell),
                   "a particle of soil '" + soil.name + "' would weigh more than 128 kg",
                   "use a smaller cell_m");
  // The limit is for all shells together; `count_pieces` stops as soon as it exceeds what is left.
  std::size_t left = limits::kShellPieces;
  for (const scene::MachineInWorld& placed : world.machines)
    for (const scene::Shell& shell : placed.machine.shells) {
      const std::size_t pieces =
          geometry::count_pieces(shell, geometry::kShellPieceCells * cell, left);
      if (pieces > left) {
        faults.error(at, "shell '" + shell.name + "' of '" + placed.name + "'",
                     "the shells of a scene may be cut to at most " +
                         std::to_string(limits::kShellPieces) + " pieces of three cells",
                     "use a larger cell_m or smaller shells");
        return;
      }
      left -= pieces;
    }
}

/// Removes planes from the shapes of a machine that stands still. A level plane is the rock.
void take_planes(const Element& world_element, const Element& at, scene::MachineInWorld& instance,
                 scene::Scene& world, Faults& faults) {
  if (instance.machine.links.empty()) return;
  scene::Link& link = instance.machine.links[0];
  const auto is_plane = [](const scene::Collision& c) {
    return c.geometry.kind == scene::Geometry::Kind::kPlane;
  };
  const auto plane = std::find_if(link.collisions.begin(), link.collisions.end(), is_plane);
  if (plane == link.collisions.end()) return;
  // A plane on the ground would be the ground, so its pose counts in the world.
  if (!at.FirstChildElement("navvy:on_ground")) instance.on_ground = false;
  const Pose X = instance.X_WM * link.X_ML * plane->X_LC;
  const double height = X.translation().z();
  const Element* ground = world_element.FirstChildElement("navvy:ground");
  // 1 - 1e-12 is the cosine of 1.4e-6 rad: more than the rounding of a pose and less than any
  // slope.
  if (X.linear().col(2).z() < 1 - 1e-12) {
    faults.error(
        at, plane->name, "a plane is the rock under the ground, and that is level",
        "for sloping ground write <navvy:ground> with <slope>, for a ramp a <box> with a <pose>");
  } else if (instance.on_ground) {
    faults.error(at, plane->name, "a plane is the rock under the ground and cannot stand on it",
                 "set <navvy:on_ground>false</navvy:on_ground>");
  } else if (ground != nullptr && ground->FirstChildElement("depth_m")) {
    faults.error(at, plane->name,
                 "the rock's height is given twice: by this plane and by depth_m of the ground",
                 "remove depth_m from <navvy:ground>, or the plane");
  } else if (world.ground.has_rock && world.ground.rock != height) {
    // Two planes of one height are one rock, as when a scene includes a ground plane twice.
    faults.error(at, plane->name, "another plane is the rock already", "remove one of them");
  } else if (ground != nullptr && world.ground.file.empty() &&
             height > world.ground.surface - 0.01) {
    // Ground of a file or with shapes is checked when it is built.
    faults.error(at, plane->name,
                 "the plane would be the ground's rock, and there is no soil above it",
                 "set surface_m of <navvy:ground> above it, or remove the plane: the ground "
                 "carries by itself");
  }
  // The plane counts in spite of a fault, so that later rules do not miss the rock as well.
  world.ground.has_rock = true;
  world.ground.rock = height;
  instance.machine.derived.push_back("its plane is the rock under the ground");
  std::erase_if(link.collisions, is_plane);
}

void read_machines(Element& world_element, scene::Scene& world, const Known& known,
                   Faults& faults) {
  // Both kinds in one walk: machines are numbered in the order of the file.
  for (Element* e : children_of(world_element, {"include", "model"})) {
    scene::MachineInWorld instance = read_instance(*e, world, known, faults);
    instance.line = e->GetLineNum();
    take_planes(world_element, *e, instance, world, faults);
    require_new_name(*e, instance.name, "machine", world.machines, "give this one a <name>",
                     faults);
    world.machines.push_back(std::move(instance));
  }
}

/// Reads the ground; returns false after a fault, which makes every place on it doubtful.
bool read_site(Element& world_element, scene::Scene& world, Faults& faults) {
  const std::size_t before = faults.error_count();
  Element* ground = world_element.FirstChildElement("navvy:ground");
  if (ground == nullptr) {
    faults.error(world_element, "", "a world needs <navvy:ground>",
                 "e.g. <navvy:ground><size_m>20 20</size_m></navvy:ground>");
    return false;
  }
  world.ground = read_ground(*ground, world.soils, world.seed, faults);
  check_grid(world_element, world, faults);
  return faults.error_count() == before;
}

}  // namespace

scene::Scene read_world(Document& document, const scene::StepKinds& kinds, Faults& faults) {
  scene::Scene world;
  world.file = document.file();
  Element& root = *document.root();
  if (!check_root(root, faults)) return world;
  const std::size_t before = faults.error_count();
  assemble(document, faults);
  check_sdf(root, faults);
  const bool sdf_sound = faults.error_count() == before;
  Element* element = root.FirstChildElement("world");
  if (!element) {
    faults.error(root, "", "a scene needs a <world name=\"...\">");
    return world;
  }
  // In the order of references: soils, ground, machines, programs, cameras.
  world.name = attribute(*element, "name");
  require_file_name(*element, world.name, faults);
  std::vector<double> v;
  Faults seen;  // check_sdf has reported these
  // 100 m/s2 is four times the gravity of Jupiter.
  if (Element* e = element->FirstChildElement("gravity");
      e && read_numbers(*e, 3, {-100, 100}, v, seen))
    world.gravity = Vec3(v[0], v[1], v[2]);
  if (Element* e = element->FirstChildElement("navvy:seed")) read_seed(*e, world.seed, faults);
  read_soils(*element, world, faults);
  read_section(*element, "navvy:solver", world.solver, faults);
  const bool ground_known = read_site(*element, world, faults);
  if (Element* e = element->FirstChildElement("navvy:design"))
    world.design = read_design(*e, faults);
  std::map<std::string, MachineFile> files;
  // After a fault in SDF elements, models of this file are not given to libsdformat, whose messages
  // have no lines.
  read_machines(*element, world, {kinds, ground_known, sdf_sound, files}, faults);
  read_hitches(*element, world, faults);
  check_cell(*element, world, faults);
  if (Element* e = element->FirstChildElement("navvy:materials"))
    world.materials = read_materials(*e, faults);
  check_materials(world, faults);
  // After all machines, as steps name machines that come later in the file.
  check_program_order(*element, world, faults);
  read_section(*element, "navvy:recording", world.recording, faults);
  if (Element* e = element->FirstChildElement("navvy:forbid"))
    world.forbidden = read_forbidden(*e, faults);
  read_goals(*element, world, faults);
  read_records(*element, world, faults);
  read_cameras(*element, world, faults);
  read_overlays(*element, world, faults);
  for (Element* e : children_of(*element, {"light"})) read_light(*e, world.lights, faults);
  return world;
}

}  // namespace navvy::scene_io
