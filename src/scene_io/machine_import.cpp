// SPDX-License-Identifier: Apache-2.0
#include "scene_io/machine_import.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "core/error.h"
#include "core/file.h"
#include "geometry/hull.h"
#include "geometry/oriented_box.h"
#include "geometry/primitive_solids.h"
#include "geometry/solid_properties.h"
#include "scene/scaled_mesh.h"
#include "scene_io/arm_import.h"
#include "scene_io/assembly.h"
#include "scene_io/bucket_reader.h"
#include "scene_io/element_reader.h"
#include "scene_io/foreign_private.h"
#include "scene_io/found_wheels.h"
#include "scene_io/loader.h"
#include "scene_io/machine_reader.h"
#include "scene_io/mass_file.h"
#include "scene_io/mesh_path.h"
#include "scene_io/sdf_rules.h"

namespace navvy::scene_io {

namespace {

namespace fs = std::filesystem;
using scene::short_text;

/// Below this density a mass is a placeholder: even a hollow body of sheet metal is heavier
/// [kg/m3] (U).
constexpr double kLeastDensity = 5;
/// A link below the first mass is a placeholder in a machine above the second [kg] (U).
constexpr double kLeastMass = 1, kHeavyMachine = 1000;

/// Returns the solid of a shape in its link's frame at 1 kg/m3; meshes count by their hulls.
geometry::SolidProperties solid_of(const scene::Geometry& shape, const Pose& X_LS) {
  using Kind = scene::Geometry::Kind;
  geometry::SolidProperties out;
  if (shape.kind == Kind::kBox) out = geometry::solid_box(shape.size);
  if (shape.kind == Kind::kCylinder) out = geometry::solid_cylinder(shape.radius, shape.length);
  if (shape.kind == Kind::kSphere) out = geometry::solid_sphere(shape.radius);
  if (shape.kind == Kind::kCone) out = geometry::solid_cone(shape.radius, shape.length);
  if (shape.kind == Kind::kCapsule) out = geometry::solid_capsule(shape.radius, shape.length);
  if (shape.kind == Kind::kMesh) {
    try {
      geometry::TriangleMesh mesh = scene::scaled_mesh(shape);
      out = geometry::solid_properties(geometry::convex_hull(std::move(mesh.vertices)).mesh);
    } catch (const InputError&) {
      // A flat mesh encloses nothing.
      return out;
    }
  }
  return out.volume > 0 ? geometry::placed(out, X_LS) : out;
}

/// Makes one machine.
class Maker {
 public:
  Maker(Document& document, Element& model, scene::Machine machine, const ImportOptions& options)
      : document_(document), model_(model), machine_(std::move(machine)), options_(options) {}

  std::vector<std::string> make(Faults& faults) {
    if (!options_.masses.empty())
      masses_ = read_masses(options_.masses, names_in_list(machine_.links));
    copy_meshes(model_, faults);
    fill_in_buckets(faults);
    weigh();
    for (const std::string& sentence :
         import_arm(document_, model_, machine_, placeholders_.empty()))
      say(sentence);
    start_within_limits();
    add_wheels();
    name_overlaps();
    say("not recognised: beds; add navvy:bed where the machine has one");
    return std::move(report_);
  }

  /// Returns the text of a file of masses with the links whose masses are placeholders; empty
  /// without any.
  std::string masses_to_fill_in() const {
    if (placeholders_.empty()) return "";
    std::string text =
        "# Masses of links in kg: correct them, then import again with --masses.\nlink,mass_kg\n";
    for (const std::string& line : placeholders_) text += line + "\n";
    return text;
  }

 private:
  void say(const std::string& sentence) { report_.push_back(sentence); }

  Element* link_element(const std::string& name) {
    for (Element* e : children_of(model_, {"link"}))
      if (attribute(*e, "name") == name) return e;
    return nullptr;
  }

  /// Copies every mesh into the folder and names the copy.
  void copy_meshes(Element& element, Faults& faults) {
    for (Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const bool of_mesh = std::string(e->Name()) == "uri" && std::string(element.Name()) == "mesh";
      std::string path;
      if (!of_mesh) {
        copy_meshes(*e, faults);
      } else if (resolve_mesh(*e, path, faults)) {
        e->SetText(copy_of(path).c_str());
      }
    }
  }

  /// Writes out the values of bucket files, whose paths count from the folder of the foreign file.
  void fill_in_buckets(Faults& faults) {
    for (Element* bucket : children_of(model_, {"navvy:bucket"})) {
      fill_in_bucket(*bucket, faults);
      bucket->DeleteAttribute("ref");
    }
  }

  /// Returns the name of the copy of a mesh file, which is made at its first use.
  std::string copy_of(const std::string& path) {
    const auto [at, is_new] = copies_.try_emplace(path);
    if (!is_new) return at->second;
    std::string name = fs::path(path).filename().string();
    // Two folders may hold files of one name.
    for (int n = 2; !names_.insert(name).second; ++n)
      name = fs::path(path).stem().string() + "_" + std::to_string(n) +
             fs::path(path).extension().string();
    fs::create_directories(fs::path(options_.folder) / "meshes");
    write_file_atomically((fs::path(options_.folder) / "meshes" / name).string(), read_file(path));
    copy_parts(path);
    return at->second = "meshes/" + name;
  }

  /// Copies the buffers of a glTF file and the materials of an OBJ file, which lie beside it.
  void copy_parts(const std::string& path) {
    const std::vector<char> bytes = read_file(path);
    const std::string text(bytes.begin(), bytes.end());
    for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path())) {
      const std::string name = entry.path().filename().string(), ending = entry.path().extension();
      if ((ending == ".bin" || ending == ".mtl") && text.find(name) != std::string::npos)
        write_file_atomically((fs::path(options_.folder) / "meshes" / name).string(),
                              read_file(entry.path().string()));
    }
  }

  /// Sets the masses of the side file, names those that are placeholders, and replaces them if a
  /// density was given.
  void weigh() {
    for (scene::Link& link : machine_.links) {
      const auto given = masses_.find(link.name);
      if (given == masses_.end()) continue;
      const geometry::SolidProperties shapes = shapes_of(link);
      say("filled in: link '" + link.name + "' weighs " + short_text(given->second) + " kg, not " +
          short_text(link.mass, 4) +
          (shapes.volume > 0 ? "; centre and inertia follow from its shapes"
                             : "; without shapes it keeps its centre"));
      set_mass(link, given->second, shapes);
    }
    const double whole = machine_.total_mass();
    for (scene::Link& link : machine_.links)
      if (masses_.count(link.name) == 0) judge_mass(link, whole);
  }

  /// Returns the sum of a link's shapes at 1 kg/m3: its collisions, otherwise its visuals.
  static geometry::SolidProperties shapes_of(const scene::Link& link) {
    geometry::SolidProperties sum;
    for (const scene::Collision& shape : link.collisions)
      sum = joined_with(sum, shape.geometry, shape.X_LC);
    if (link.collisions.empty())
      for (const scene::Visual& shape : link.visuals)
        sum = joined_with(sum, shape.geometry, shape.X_LV);
    return sum;
  }

  /// Names a mass that is a placeholder in a machine of the mass `whole` [kg], or replaces it.
  void judge_mass(scene::Link& link, double whole) {
    const geometry::SolidProperties shapes = shapes_of(link);
    const bool light = shapes.volume > 0 && link.mass < kLeastDensity * shapes.volume;
    const bool tiny = link.mass < kLeastMass && whole > kHeavyMachine;
    if (!light && !tiny) return;
    const std::string what = "link '" + link.name + "' has " + short_text(link.mass) + " kg in " +
                             (light ? "shapes of " + short_text(shapes.volume) + " m3"
                                    : "a machine of " + short_text(whole, 4) + " kg") +
                             ", a placeholder";
    if (options_.density > 0 && shapes.volume > 0) {
      set_mass(link, options_.density * shapes.volume, shapes);
      say("replaced: " + what + ": " + short_text(link.mass) + " kg by the density");
      return;
    }
    placeholders_.push_back(link.name + "," + short_text(link.mass));
    say("kept: " + what +
        (shapes.volume > 0
             ? "; --mass-from-density KG_PER_M3 or --masses FILE replaces it"
             : "; --masses FILE replaces it, as it has no shapes for --mass-from-density") +
        " (masses.csv lists them)");
  }

  /// Gives a link a mass, with centre and inertia of its shapes if they have a volume.
  void set_mass(scene::Link& link, double mass, const geometry::SolidProperties& shapes) {
    if (shapes.volume > 0) {
      link.p_LCom = shapes.p_BCom;
      link.inertia = mass / shapes.volume * shapes.inertia;
    } else {
      link.inertia *= mass / link.mass;
    }
    link.mass = mass;
    if (Element* element = link_element(link.name)) write_inertial(*element, link);
  }

  /// Names links that are in each other without a joint between them. Shapes count as boxes.
  void name_overlaps() {
    constexpr double kDeep = 0.02;
    constexpr std::size_t kNamed = 5;
    std::vector<std::vector<geometry::OrientedBox>> boxes;
    for (const scene::Link& link : machine_.links) {
      boxes.emplace_back();
      // A plane has no end, so that half of the machine would be in it.
      for (const scene::Collision& one : link.collisions)
        if (one.geometry.kind != scene::Geometry::Kind::kPlane)
          boxes.back().push_back(box_of(one.geometry, link.X_ML * one.X_LC));
    }
    std::size_t found = 0;
    for (std::size_t a = 0; a < boxes.size(); ++a)
      for (std::size_t b = a + 1; b < boxes.size(); ++b) {
        const scene::Joint& above = machine_.joints[b - 1];
        if (above.parent == static_cast<int>(a)) continue;
        double depth = 0;
        for (const geometry::OrientedBox& one : boxes[a])
          for (const geometry::OrientedBox& other : boxes[b])
            depth = std::max(depth, geometry::penetration(one, other));
        if (depth < kDeep || ++found > kNamed) continue;
        say("overlapping: the hulls of links '" + machine_.links[a].name + "' and '" +
            machine_.links[b].name + "' are " + short_text(depth, 2) +
            " m in each other, as boxes; links of one machine never collide with each other");
      }
    if (found > kNamed)
      say("overlapping: " + std::to_string(found - kNamed) + " more pairs of links");
  }

  /// Returns a box around a shape other than a plane.
  static geometry::OrientedBox box_of(const scene::Geometry& shape, const Pose& X_MS) {
    using Kind = scene::Geometry::Kind;
    geometry::OrientedBox out;
    out.X_WO = X_MS;
    const double r = shape.radius, h = 0.5 * shape.length;
    out.half = Vec3(r, r,
                    shape.kind == Kind::kSphere    ? r
                    : shape.kind == Kind::kCapsule ? h + r
                                                   : h);
    if (shape.kind == Kind::kBox) out.half = 0.5 * shape.size;
    if (shape.kind == Kind::kMesh) {
      const geometry::Box box = geometry::bounds(scene::scaled_mesh(shape));
      out.half = 0.5 * (box.high - box.low);
      out.X_WO.translation() = X_MS * Vec3(0.5 * (box.high + box.low));
    }
    return out;
  }

  static geometry::SolidProperties joined_with(const geometry::SolidProperties& sum,
                                               const scene::Geometry& shape, const Pose& X) {
    const geometry::SolidProperties solid = solid_of(shape, X);
    return solid.volume > 0 ? geometry::joined(sum, solid) : sum;
  }

  void write_inertial(Element& element, const scene::Link& link) {
    if (Element* old = element.FirstChildElement("inertial")) element.DeleteChild(old);
    Element& inertial = append(document_, element, "inertial", element);
    const Vec3& p = link.p_LCom;
    append(document_, inertial, "pose", element,
           short_text(p.x()) + " " + short_text(p.y()) + " " + short_text(p.z()) + " 0 0 0");
    append(document_, inertial, "mass", element, scene::exact_text(link.mass));
    Element& inertia = append(document_, inertial, "inertia", element);
    const char* names[3][3] = {{"ixx", "ixy", "ixz"}, {"", "iyy", "iyz"}, {"", "", "izz"}};
    for (int r = 0; r < 3; ++r)
      for (int c = r; c < 3; ++c)
        append(document_, inertia, names[r][c], element, scene::exact_text(link.inertia(r, c)));
  }

  void start_within_limits() {
    for (const scene::Joint& joint : machine_.joints) {
      if (!joint.has_limits || (joint.initial >= joint.lower && joint.initial <= joint.upper))
        continue;
      const double start = std::clamp(joint.initial, joint.lower, joint.upper);
      Element& element = append(document_, model_, "navvy:joint", model_);
      element.SetAttribute("name", joint.name.c_str());
      const bool turns = joint.type == scene::Joint::Type::kRevolute;
      append(document_, element, turns ? "initial_deg" : "initial_m", model_,
             scene::exact_text(turns ? degrees(start) : start));
      say("repaired: joint '" + joint.name + "' would start beyond its limits; it starts at " +
          short_text(turns ? degrees(start) : start) + (turns ? " deg" : " m"));
    }
  }

  void add_wheels() {
    if (!machine_.wheels.empty()) return say("kept: the wheels of the file");
    std::vector<FoundWheel> wheels = find_wheels(machine_);
    if (wheels.empty())
      return say("not recognised: no link rolls on the ground; see docs/import.md");
    const double load = machine_.total_mass() * kGravity / static_cast<double>(wheels.size());
    for (const FoundWheel& wheel : wheels) add_wheel(wheel, load);
    add_drive(wheels);
  }

  void add_wheel(const FoundWheel& wheel, double load) {
    const scene::Joint& joint = machine_.joints[static_cast<std::size_t>(wheel.joint)];
    const scene::Link& link = machine_.links[static_cast<std::size_t>(joint.child)];
    // The tyre touches the ground by its own law.
    if (Element* element = link_element(link.name))
      for (Element* e : children_of(*element, {"collision"})) element->DeleteChild(e);
    if (wheel.points_right) turn_axis(joint.name);
    Element& out = append(document_, model_, "navvy:wheel", model_);
    out.SetAttribute("name", link.name.c_str());
    append(document_, out, "joint", model_, joint.name);
    if (wheel.steer >= 0)
      append(document_, out, "steer_joint", model_,
             machine_.joints[static_cast<std::size_t>(wheel.steer)].name);
    if (is_driven(wheel)) append(document_, out, "driven", model_, "true");
    const auto number = [&](const char* name, double value, double least, double most) {
      append(document_, out, name, model_, short_text(std::clamp(value, least, most)));
    };
    number("radius_m", wheel.radius, 0.01, 5);
    number("width_m", wheel.width, 0.005, 5);
    // A tyre of solid rubber gives way by 2 % of its radius, and rebounds once.
    const double stiffness = std::clamp(load / (0.02 * wheel.radius), 100.0, 1e9);
    number("stiffness_n_per_m", stiffness, 100, 1e9);
    number("damping_n_s_per_m", 0.6 * std::sqrt(stiffness * load / kGravity), 0, 1e8);
    number("friction", std::min(wheel.friction, 1.0), 0, 3);
    say("made: wheel '" + link.name + "' on joint '" + joint.name + "', radius " +
        short_text(wheel.radius) + " m, width " + short_text(wheel.width) + " m" +
        (wheel.steer >= 0 ? ", steered" : "") + (is_driven(wheel) ? ", driven" : "") +
        (wheel.caster ? ", a caster" : "") +
        "; its collisions are removed, a tyre touches instead");
  }

  bool is_driven(const FoundWheel& wheel) const { return wheel.steer < 0 && !wheel.caster; }

  /// Turns an axis that points to the right, so that a positive speed drives ahead.
  void turn_axis(const std::string& joint) {
    for (Element* e : children_of(model_, {"joint"})) {
      Element* axis = attribute(*e, "name") == joint ? e->FirstChildElement("axis") : nullptr;
      Element* xyz = axis != nullptr ? axis->FirstChildElement("xyz") : nullptr;
      std::vector<double> v;
      Faults unread;
      if (xyz == nullptr || !read_numbers(*xyz, 3, {}, v, unread)) continue;
      const auto minus = [](double x) { return scene::exact_text(x == 0 ? 0.0 : -x); };
      xyz->SetText((minus(v[0]) + " " + minus(v[1]) + " " + minus(v[2])).c_str());
      say("repaired: the axis of joint '" + joint +
          "' pointed to the right and was turned: a positive speed drives ahead");
    }
  }

  /// Adds the drive that fits the wheels: by steering, or by the difference of both sides.
  void add_drive(const std::vector<FoundWheel>& wheels) {
    Vec3 steered = Vec3::Zero(), driven = Vec3::Zero();
    double left = 0, right = 0, king_pins = 0, angle = 0, speed = 1e9, force = 0, radius = 0;
    int n_steered = 0, n_driven = 0, n_left = 0, n_right = 0;
    for (const FoundWheel& wheel : wheels) {
      const scene::Joint& joint = machine_.joints[static_cast<std::size_t>(wheel.joint)];
      if (wheel.steer >= 0) {
        const scene::Joint& pin = machine_.joints[static_cast<std::size_t>(wheel.steer)];
        if (pin.has_limits) angle = std::max({angle, std::abs(pin.lower), std::abs(pin.upper)});
        king_pins = std::max(king_pins, 2 * std::abs(wheel.p_MW.y()));
        steered += wheel.p_MW, ++n_steered;
      }
      if (!is_driven(wheel)) continue;
      driven += wheel.p_MW, ++n_driven;
      (wheel.p_MW.y() > 0 ? left : right) += wheel.p_MW.y();
      ++(wheel.p_MW.y() > 0 ? n_left : n_right);
      radius = wheel.radius;
      if (joint.velocity < 1e8 && joint.velocity > 0)
        speed = std::min(speed, joint.velocity * wheel.radius);
      if (joint.effort < 1e8) force += joint.effort / wheel.radius;
    }
    if (n_left == 0 || n_right == 0)
      return say("not recognised: no drive, as wheels that could be driven are not on both sides");
    // Without limits in the file: a walking pace, and half of what the wheels can hold.
    const bool known_speed = speed<1e8, known_force = force> 0;
    if (!known_speed) speed = std::max(1.0, 5 * radius);
    if (!known_force) force = 0.5 * machine_.total_mass() * kGravity;
    const bool ackermann = n_steered >= 2;
    Element& drive = append(document_, model_, "navvy:drive", model_);
    drive.SetAttribute("type", ackermann ? "ackermann" : "differential");
    const auto number = [&](const char* name, double value, double least, double most) {
      append(document_, drive, name, model_, short_text(std::clamp(value, least, most)));
    };
    number("max_speed_m_per_s", speed, 0.01, 50);
    number("tractive_force_n", force, 0.1, 1e7);
    number("power_w", force * speed, 0.1, 1e7);
    number("brake_force_n", force, 0, 1e7);
    if (ackermann) {
      number("max_steer_deg", degrees(angle), 0, 80);
      number("wheelbase_m", std::abs(steered.x() / n_steered - driven.x() / n_driven), 0.01, 50);
      number("track_m", king_pins, 0.01, 50);
    } else {
      number("track_m", left / n_left - right / n_right, 0.01, 50);
    }
    say(std::string("made: a drive by ") +
        (ackermann ? "steered wheels" : "the difference of sides") + ", " + short_text(speed) +
        " m/s" + (known_speed ? "" : " (assumed)") + ", " + short_text(force) + " N" +
        (known_force ? "" : " (assumed)"));
  }

  Document& document_;
  Element& model_;
  scene::Machine machine_;
  const ImportOptions& options_;
  std::vector<std::string> report_;
  std::map<std::string, double> masses_;       ///< of the side file [kg]
  std::vector<std::string> placeholders_;      ///< lines of masses.csv
  std::map<std::string, std::string> copies_;  ///< names of copied meshes by path
  std::set<std::string> names_;                ///< names of copied files
};

std::string report_text(const std::string& file, const std::vector<std::string>& report) {
  std::string text = "# Import of " + fs::path(file).filename().string() + "\n";
  for (const std::string& sentence : report) text += "- " + sentence + "\n";
  return text;
}

}  // namespace

std::vector<std::string> import_machine(const std::string& file, const ImportOptions& options) {
  Faults faults;
  const auto document = Document::open(file, faults);
  faults.finish();
  Element& root = *document->root();
  check_root(root, faults);
  assemble(*document, faults);
  Element* model = root.FirstChildElement("model");
  if (model == nullptr)
    faults.error(root, root.Name(), "only a file with one machine can be imported",
                 "name the file of the model that a world includes");
  faults.finish();
  Faults read;
  scene::Machine machine = read_machine_file(file, read);
  read.finish();
  const std::string to = (fs::path(options.folder) / "model.sdf").string();
  std::error_code unknown;
  if (fs::exists(to, unknown))
    throw InputError(Fault{Fault::Severity::kError, to, 0, "--out", "",
                           "there is a machine already", "name another folder, or remove it"});
  fs::create_directories(options.folder, unknown);
  root.SetAttribute("xmlns:navvy", "navvy");
  Maker maker(*document, *model, std::move(machine), options);
  std::vector<std::string> report = maker.make(faults);
  faults.finish();
  for (const Fault& fault : read.list())
    if (fault.severity == Fault::Severity::kWarning)
      report.push_back("dropped or assumed by the reader: " + fault.text());
  write_file_atomically(to, document->text());
  if (const std::string masses = maker.masses_to_fill_in(); !masses.empty())
    write_file_atomically((fs::path(options.folder) / "masses.csv").string(), masses);
  // What was written must be a machine by our own, stricter rules.
  for (const Fault& fault : check(to, scene::StepKinds{}))
    report.push_back((fault.severity == Fault::Severity::kError ? "to correct: " : "note: ") +
                     fault.text());
  write_file_atomically((fs::path(options.folder) / "IMPORT.md").string(),
                        report_text(file, report));
  return report;
}

}  // namespace navvy::scene_io
