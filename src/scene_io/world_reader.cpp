// SPDX-License-Identifier: Apache-2.0
#include "scene_io/world_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "core/limits.h"
#include "geometry/pieces.h"
#include "scene/soil_values.h"
#include "scene_io/assembly.h"
#include "scene_io/design_reader.h"
#include "scene_io/fields.h"
#include "scene_io/ground_reader.h"
#include "scene_io/hitch_reader.h"
#include "scene_io/machine_reader.h"
#include "scene_io/materials_reader.h"
#include "scene_io/mesh_path.h"
#include "scene_io/program_order.h"
#include "scene_io/program_reader.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/soil_reader.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {

namespace {

/// What has been read of a machine's file.
struct MachineFile {
  scene::Machine machine;
  std::size_t elements = 0;
};

void read_solver(Element& element, scene::SolverSettings& solver, Faults& faults) {
  // A cell below 5 mm or above 2 m is a slip of units; the particles' number follows from its cube.
  Fields(element, faults)
      .number("cell_m", solver.cell, {0.005, 2})
      .number("courant", solver.courant, {0.05, 1})
      .number("max_step_s", solver.max_step, {1e-6, 0.02})
      .number("control_rate_hz", solver.control_rate, {0.001, 1e5})
      .whole("max_particles", solver.max_particles, {1000, limits::kParticles})
      .number("awake_zone", solver.active_zone, {0.5, 4})
      .finish();
}

void read_recording(Element& element, scene::Recording& recording, Faults& faults) {
  Fields(element, faults)
      .number("duration_s", recording.duration, {1e-3, 1e6})
      .number("settle_s", recording.settle, {0, 1e5})
      .number("telemetry_rate_hz", recording.telemetry_rate, {0.01, 1e5})
      .flag("render", recording.render)
      .finish();
}

/// Names of scenes, cameras and maps become names of files.
void require_file_name(const Element& element, const std::string& name, Faults& faults) {
  const bool plain = name != "." && name != ".." && name.find('/') == std::string::npos &&
                     std::none_of(name.begin(), name.end(),
                                  [](char c) { return static_cast<unsigned char>(c) < 32; });
  if (!plain)
    faults.error(element, name, "results are named after it: no '/', no '..'",
                 "use letters, digits, _ and -");
}

/// Formats and layers are known to whoever writes them: they are checked there, with the line that
/// is kept here.
scene::MapRecord read_record(Element& element, Faults& faults) {
  scene::MapRecord record;
  record.line = element.GetLineNum();
  record.name = attribute(element, "name");
  std::string layers;
  Fields(element, faults)
      .attribute("name")
      .text("format", record.format)
      .required("format")
      .text("layers", layers)
      .number("rate_hz", record.rate, {0.001, 1000})
      .number("machine_rate_hz", record.machine_rate, {0.001, 1000})
      .finish();
  record.layers = words_of(layers);
  if (record.name.empty())
    faults.error(element, "", "needs an attribute name=\"...\"", "it names the files");
  require_file_name(element, record.name, faults);
  check_name(element, record.name, faults);
  return record;
}

scene::Camera read_camera(Element& element, const scene::Scene& world, Faults& faults) {
  scene::Camera camera;
  camera.name = attribute(element, "name");
  // Everything is read first and judged then, so that one camera can have several faults at once.
  Fields fields(element, faults);
  fields.attribute("name")
      .text("machine", camera.machine)
      .text("link", camera.link)
      .vec3("position_m", camera.position, {-1e6, 1e6})
      .vec3("target_m", camera.target, {-1e6, 1e6})
      .number("fov_deg", camera.fov, {1, 170}, kDegree)
      .whole("width_px", camera.width, {16, 8192})
      .whole("height_px", camera.height, {16, 8192})
      .number("rate_hz", camera.rate, {0.001, 1000})
      .finish();
  if (camera.name.empty())
    faults.error(element, "", "needs an attribute name=\"...\"", "it names the pictures");
  require_file_name(element, camera.name, faults);
  if (!camera.machine.empty())
    // The frame of the two points follows from what is named: nothing, a machine, or a link of it.
    camera.kind = camera.link.empty() ? scene::Camera::Kind::kChase : scene::Camera::Kind::kOnLink;
  if (camera.machine.empty() && !camera.link.empty())
    faults.error(element, camera.link, "a camera on a link needs <machine>, too");
  // A camera that looks at its own place has no direction.
  if ((camera.position - camera.target).norm() < 1e-3)
    faults.error(element, "", "position_m and target_m must not be the same place");
  if (camera.machine.empty()) return camera;
  const int index = world.machine_index(camera.machine);
  std::vector<std::string> names;
  if (index < 0) {
    for (const auto& machine : world.machines) names.push_back(machine.name);
    faults.error(*fields.child("machine"), camera.machine, "no machine of this name in the world",
                 faults.nearest(camera.machine, names));
    return camera;
  }
  const scene::Machine& machine = world.machines[static_cast<std::size_t>(index)].machine;
  // Without links the machine had faults of its own, which have been reported.
  if (camera.link.empty() || machine.links.empty() || machine.link_index(camera.link) >= 0)
    return camera;
  for (const scene::Link& link : machine.links) names.push_back(link.name);
  faults.error(*fields.child("link"), camera.link, "no link of this name in the machine",
               faults.nearest(camera.link, names));
  return camera;
}

void read_light(Element& element, std::vector<scene::Light>& lights, Faults& faults) {
  if (attribute(element, "type") != "directional") {
    // Point and spot lights would need places and falls of brightness that the pictures do not
    // know.
    faults.warning(element, attribute(element, "type"), "is ignored",
                   "only directional lights are drawn");
    return;
  }
  scene::Light light;
  std::vector<double> v;
  Faults seen;  // check_sdf has told what is no number
  if (Element* e = element.FirstChildElement("direction"); e && read_numbers(*e, 3, {}, v, seen)) {
    light.direction = Vec3(v[0], v[1], v[2]);
    if (light.direction.norm() < 1e-9)
      faults.error(*e, text_of(*e), "a direction must not be zero");
    else
      light.direction.normalize();
  }
  if (Element* e = element.FirstChildElement("diffuse")) {
    // Alpha may be left out; what is no number was reported by check_sdf and counts as 1.
    const auto words = words_of(text_of(*e));
    double c[4] = {1, 1, 1, 1};
    for (std::size_t i = 0; i < 4 && i < words.size(); ++i) to_number(words[i], c[i]);
    light.color = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]),
                   static_cast<float>(c[3])};
  }
  lights.push_back(light);
}

void read_load(Element& element, scene::MachineInWorld& instance, const scene::Scene& world,
               Faults& faults) {
  // A world of one soil need not name it.
  if (!world.soils.empty()) instance.load.soil = world.soils[0].name;
  Fields fields(element, faults);
  fields.text("soil", instance.load.soil)
      .number("mass_kg", instance.load.mass, {0, 1e6})
      .required("mass_kg")
      .finish();
  if (fields.has("soil") && world.soil_index(instance.load.soil) < 0) {
    std::vector<std::string> names;
    for (const scene::Soil& soil : world.soils) names.push_back(soil.name);
    faults.error(*fields.child("soil"), instance.load.soil, "no soil of this name in the world",
                 faults.nearest(instance.load.soil, names));
  }
  if (!instance.machine.links.empty() && instance.machine.beds.empty())
    // A machine without links is one that could not be read.
    faults.error(element, instance.name, "only a machine with <navvy:bed> carries a load");
  const int soil = world.soil_index(instance.load.soil);
  if (soil < 0 || instance.machine.beds.empty()) return;
  const scene::Soil& kind = world.soils[static_cast<std::size_t>(soil)];
  // Loose soil: the bank density divided by the swell.
  const double struck = instance.machine.beds[0].capacity * kind.bank_density / kind.swell;
  if (instance.load.mass > struck)
    faults.warning(element, child_text(element, "mass_kg"),
                   "more than the bed holds struck, " + std::to_string(std::lround(struck)) +
                       " kg of loose '" + kind.name + "'",
                   "what is heaped may fall off");
}

/// What has been settled before the machines are read.
struct Known {
  const scene::StepKinds& kinds;
  bool ground = false;     ///< the site was read without errors
  bool sdf_sound = false;  ///< and so was the SDF of the file
  /// Machines by their files: forty excavators are read once, and a fault in their file is told
  /// once.
  std::map<std::string, MachineFile>& files;
};

/// The machine of a file, read at its first use.
const scene::Machine& machine_of(const std::string& path, const Known& known, Faults& faults) {
  const auto [at, is_new] = known.files.try_emplace(path);
  MachineFile& file = at->second;
  const std::size_t before = faults.work.elements;
  if (is_new) {
    file.machine = read_machine_file(path, faults);
    file.elements = faults.work.elements - before;
  } else {
    // A copy is cheaper than reading, but not for nothing: the scene that is written out holds them
    // all.
    faults.work.elements += file.elements;
  }
  return file.machine;
}

// What <include> and an inline <model> share: place, joints, program.
void read_instance(Element& element, scene::MachineInWorld& instance, const scene::Scene& world,
                   const Known& known, Faults& faults) {
  if (Element* pose = element.FirstChildElement("pose")) {
    // A pose that is too short is reported by check_sdf; it is not read a second time here.
    if (words_of(text_of(*pose)).size() >= 6) read_pose(*pose, instance.X_WM, faults);
    if (pose->Attribute("relative_to"))
      faults.error(*pose, attribute(*pose, "relative_to"), "relative_to is not supported here",
                   "give the pose in the world");
    const Vec2 place = instance.X_WM.translation().head<2>();
    const Vec2 low = world.ground.origin, high = low + world.ground.size;
    // The site's edges count as on it. Without a sound ground there is no site to be off.
    if (known.ground &&
        ((place.array() < low.array()).any() || (place.array() > high.array()).any()))
      faults.error(*pose, text_of(*pose), "the machine must stand on the site",
                   "move it, or enlarge size_m of the ground");
  }
  if (Element* e = element.FirstChildElement("navvy:on_ground"))
    read_flag(*e, instance.on_ground, faults);
  // A model that stands in the world itself gives its joints among its own elements.
  if (!instance.machine.links.empty() && std::string(element.Name()) == "include")
    for (Element* e = element.FirstChildElement("navvy:joint"); e;
         e = e->NextSiblingElement("navvy:joint"))
      read_initial_position(*e, instance.machine, faults);
  if (Element* e = element.FirstChildElement("navvy:load")) read_load(*e, instance, world, faults);
  if (Element* e = element.FirstChildElement("navvy:program"))
    // Read against machine and ground, so that what neither allows is found before the run.
    instance.program = read_program(*e, known.kinds, &instance.machine,
                                    known.ground ? &world.ground : nullptr, faults);
}

/// A scene may move a machine by its commands alone that its file gives masses; it cannot give
/// masses to one without.
void choose_engine(const Element& engine, scene::Machine& machine, Faults& faults) {
  const std::string value = text_of(engine);
  if (value != "kinematic" && value != "dynamic")
    faults.error(engine, value, "must be dynamic or kinematic");
  else if (value == "dynamic" && machine.kinematic)
    faults.error(engine, value, "the machine's own file says kinematic: its links need no masses",
                 "set <navvy:engine>dynamic</navvy:engine> in " + machine.file);
  else if (value == "kinematic")
    machine.kinematic = true;
}

scene::MachineInWorld read_include(Element& element, const scene::Scene& world, const Known& known,
                                   Faults& faults) {
  scene::MachineInWorld instance;
  Element* uri = element.FirstChildElement("uri");
  std::string path;
  if (!uri) {
    faults.error(element, "", "needs an element <uri>", "e.g. <uri>model://ew180</uri>");
  } else if (!text_of(*uri).empty() && resolve_model(*uri, path, faults)) {
    if (faults.work.elements > limits::kSceneElements) {
      faults.error(element, text_of(*uri),
                   "a scene and its machines may have at most " +
                       std::to_string(limits::kSceneElements) + " elements together",
                   "use fewer or simpler machines");
      return instance;
    }
    instance.machine = machine_of(path, known, faults);
  }
  // Unnamed, it goes by its model's name; two of one kind must be told apart by <name>.
  instance.name =
      element.FirstChildElement("name") ? child_text(element, "name") : instance.machine.name;
  if (const Element* name = element.FirstChildElement("name"))
    check_name(*name, instance.name, faults);
  const std::string is_static = child_text(element, "static");
  if (is_static == "true" || is_static == "1") instance.machine.fixed_base = true;
  if (const Element* engine = element.FirstChildElement("navvy:engine"))
    choose_engine(*engine, instance.machine, faults);
  read_instance(element, instance, world, known, faults);
  return instance;
}

void read_soils(Element& world_element, scene::Scene& world, Faults& faults) {
  for (Element* e = world_element.FirstChildElement("navvy:soil"); e;
       e = e->NextSiblingElement("navvy:soil")) {
    scene::Soil soil = read_soil(*e, faults);
    if (!soil.name.empty() && world.soil_index(soil.name) >= 0)
      // Found in the order of the file, so the second one is blamed.
      faults.error(*e, soil.name, "there is already a soil of this name",
                   "give this one another name=\"...\"");
    world.soils.push_back(std::move(soil));
  }
  if (!world_element.FirstChildElement("navvy:soil"))
    faults.error(world_element, "", "a world needs a soil", "add <navvy:soil ref=\"loam\"/>");
}

void check_grid(const Element& world_element, const scene::Scene& world, Faults& faults) {
  const Vec2 cells = world.ground.size / world.solver.cell;
  const Element* ground = world_element.FirstChildElement("navvy:ground");
  const Element& at = ground ? *ground : world_element;
  if (cells.minCoeff() < 4)
    faults.error(at, "", "the site must be at least 4 cells wide",
                 "smaller cell_m or larger size_m");
  // 2^16 columns an edge: the sparse tables index columns with 16 bits and more is never meant.
  if (cells.maxCoeff() > 65536)
    faults.error(at, "", "the site must be at most 65536 cells wide",
                 "larger cell_m or smaller size_m");
}

/// What only the cell tells: how heavy particles and how many pieces of shells become.
void check_cell(const Element& world_element, const scene::Scene& world, Faults& faults) {
  const Element* solver = world_element.FirstChildElement("navvy:solver");
  const Element& at = solver ? *solver : world_element;
  const double cell = world.solver.cell;
  for (const scene::Soil& soil : world.soils)
    if (scene::heaviest_particle(soil, cell) / kMassQuantum >
        std::numeric_limits<std::int32_t>::max())
      faults.error(at, std::to_string(cell),
                   "a particle of soil '" + soil.name + "' would weigh more than 128 kg",
                   "use a smaller cell_m");
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

void read_seed(const Element& element, std::uint64_t& seed, Faults& faults) {
  const std::string text = text_of(element);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (text.empty() || result.ec != std::errc() || result.ptr != text.data() + text.size())
    faults.error(element, text, "must be a whole number from 0 to 18446744073709551615");
}

/// Takes the planes of what stands still out of its shapes: a level one is the rock under the
/// ground.
void take_planes(const Element& world_element, const Element& at, scene::MachineInWorld& instance,
                 scene::Scene& world, Faults& faults) {
  if (instance.machine.links.empty()) return;
  scene::Link& link = instance.machine.links[0];
  const auto is_plane = [](const scene::Collision& c) {
    return c.geometry.kind == scene::Geometry::Kind::kPlane;
  };
  const auto plane = std::find_if(link.collisions.begin(), link.collisions.end(), is_plane);
  if (plane == link.collisions.end()) return;
  // It lies where its file says: on the ground it would be the ground.
  if (!at.FirstChildElement("navvy:on_ground")) instance.on_ground = false;
  const Pose X = instance.X_WM * link.X_ML * plane->X_LC;
  const double height = X.translation().z();
  const Element* ground = world_element.FirstChildElement("navvy:ground");
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
    faults.error(at, plane->name, "another plane is the rock already", "remove one of them");
  } else if (ground != nullptr && world.ground.file.empty() &&
             height > world.ground.surface - 0.01) {
    // Of a file or of shapes the ground itself tells when it is laid.
    faults.error(at, plane->name,
                 "the plane would be the ground's rock, and there is no soil above it",
                 "set surface_m of <navvy:ground> above it, or remove the plane: the ground "
                 "carries by itself");
  }
  world.ground.has_rock = true;
  world.ground.rock = height;
  instance.machine.derived.push_back("its plane is the rock under the ground");
  std::erase_if(link.collisions, is_plane);
}

void read_machines(Element& world_element, scene::Scene& world, const Known& known,
                   Faults& faults) {
  // Both kinds in one walk, as machines are numbered in the order of the file and programs wait for
  // each other by name.
  for (Element* e = world_element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    if (kind != "include" && kind != "model") continue;
    scene::MachineInWorld instance;
    if (kind == "include") {
      instance = read_include(*e, world, known, faults);
    } else {
      instance.machine = read_machine(*e, known.sdf_sound, faults);
      instance.name = instance.machine.name;
      read_instance(*e, instance, world, known, faults);
    }
    instance.line = e->GetLineNum();
    take_planes(world_element, *e, instance, world, faults);
    if (!instance.name.empty() && world.machine_index(instance.name) >= 0)
      faults.error(*e, instance.name, "there is already a machine of this name",
                   "give this one a <name>");
    world.machines.push_back(std::move(instance));
  }
}

}  // namespace

scene::Machine read_machine_file(const std::string& file, Faults& faults) {
  const auto document = Document::open(file, faults);
  if (!document || !check_root(*document->root(), faults)) return {};
  Element& root = *document->root();
  // Faults of the file itself; those of other files that were read before do not keep this one from
  // being read.
  const std::size_t before = faults.error_count();
  // What a part lacks would be told once more of the whole.
  if (!assemble(*document, faults)) return {};
  check_sdf(root, faults);
  Element* model = root.FirstChildElement("model");
  if (!model) {
    faults.error(root, "", "a machine file needs a <model>");
    return {};
  }
  // A machine file is used in many worlds, so what belongs to one of them is refused here.
  if (Element* program = model->FirstChildElement("navvy:program"))
    faults.error(*program, "", "a program belongs to the world that uses the machine",
                 "move it into <include>");
  for (const char* name : {"navvy:on_ground", "navvy:load"})
    if (Element* e = model->FirstChildElement(name))
      faults.error(*e, "", "belongs to the world that uses the machine", "move it into <include>");
  return read_machine(*model, faults.error_count() == before, faults);
}

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
    faults.error(root, "", "a scene needs a <world name=\"...\">", "");
    return world;
  }
  // Reading goes in the order in which things refer to each other: soils, ground, machines,
  // programs, cameras.
  world.name = attribute(*element, "name");
  require_file_name(*element, world.name, faults);
  std::vector<double> v;
  Faults seen;  // check_sdf has reported these
  if (Element* e = element->FirstChildElement("gravity");
      e && read_numbers(*e, 3, {-100, 100}, v, seen))
    world.gravity = Vec3(v[0], v[1], v[2]);
  if (Element* e = element->FirstChildElement("navvy:seed")) read_seed(*e, world.seed, faults);
  read_soils(*element, world, faults);
  if (Element* e = element->FirstChildElement("navvy:solver"))
    read_solver(*e, world.solver, faults);
  // Faults in the ground make every place on it doubtful, so machines are then read without it.
  const std::size_t before_ground = faults.error_count();
  Element* ground = element->FirstChildElement("navvy:ground");
  if (ground) {
    world.ground = read_ground(*ground, world.soils, world.seed, faults);
    check_grid(*element, world, faults);
  } else {
    faults.error(*element, "", "a world needs <navvy:ground>",
                 "e.g. <navvy:ground><size_m>20 20</size_m></navvy:ground>");
  }
  if (Element* e = element->FirstChildElement("navvy:design"))
    world.design = read_design(*e, faults);
  const bool ground_known = ground && faults.error_count() == before_ground;
  std::map<std::string, MachineFile> files;
  read_machines(*element, world, {kinds, ground_known, sdf_sound, files}, faults);
  read_hitches(*element, world, faults);
  check_cell(*element, world, faults);
  if (Element* e = element->FirstChildElement("navvy:materials"))
    world.materials = read_materials(*e, faults);
  check_materials(world, faults);
  // After all machines, as steps name machines that stand further down in the file.
  check_program_order(*element, world, faults);
  if (Element* e = element->FirstChildElement("navvy:recording"))
    read_recording(*e, world.recording, faults);
  for (Element* e = element->FirstChildElement("navvy:record"); e;
       e = e->NextSiblingElement("navvy:record")) {
    scene::MapRecord record = read_record(*e, faults);
    for (const scene::MapRecord& other : world.records)
      if (!record.name.empty() && other.name == record.name)
        faults.error(*e, record.name, "there is already a record of this name",
                     "rename one of them");
    world.records.push_back(std::move(record));
  }
  for (Element* e = element->FirstChildElement("navvy:camera"); e;
       e = e->NextSiblingElement("navvy:camera")) {
    scene::Camera camera = read_camera(*e, world, faults);
    for (const scene::Camera& other : world.cameras)
      if (!camera.name.empty() && other.name == camera.name)
        faults.error(*e, camera.name, "there is already a camera of this name",
                     "rename one of them");
    world.cameras.push_back(std::move(camera));
  }
  for (Element* e = element->FirstChildElement("light"); e; e = e->NextSiblingElement("light"))
    read_light(*e, world.lights, faults);
  return world;
}

}  // namespace navvy::scene_io
