// SPDX-License-Identifier: Apache-2.0
#include "scene_io/machine_reader.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "geometry/topology.h"
#include "scene_io/fields.h"
#include "scene_io/mesh_path.h"
#include "scene_io/sdf_model.h"

namespace navvy::scene_io {

namespace {

/// Names of a <model> as written, known even where the SDF part has faults.
struct Names {
  std::vector<std::string> links, joints, frames, shells;
  std::map<std::string, std::string> joint_type;
};

Names names_of(const Element& model) {
  Names names;
  for (const Element* e = model.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name(), name = attribute(*e, "name");
    if (kind == "link") names.links.push_back(name);
    if (kind == "frame") names.frames.push_back(name);
    if (kind == "navvy:shell") names.shells.push_back(name);
    if (kind == "joint") {
      names.joints.push_back(name);
      names.joint_type[name] = attribute(*e, "type");
    }
  }
  return names;
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// A child whose text must be one of `names`.
void require_name(const Element& element, const char* child_name, const char* what,
                  const std::vector<std::string>& names, Faults& faults) {
  const Element* child = element.FirstChildElement(child_name);
  if (!child || text_of(*child).empty() || contains(names, text_of(*child))) return;
  faults.error(*child, text_of(*child), std::string("no ") + what + " of this name in the model",
               suggestion(text_of(*child), names));
}

void require_attribute_name(const Element& element, Faults& faults) {
  if (attribute(element, "name").empty()) faults.error(element, "", "needs an attribute name=\"...\"");
}

// What libsdformat would find without a line number.
bool check_joints(const Element& model, const Names& names, Faults& faults) {
  const std::size_t before = faults.error_count();
  static const std::set<std::string> types = {"fixed", "revolute", "continuous", "prismatic", "ball"};
  std::vector<std::string> ends = names.links;
  ends.insert(ends.end(), names.frames.begin(), names.frames.end());
  for (const Element* joint = model.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
    const std::string type = attribute(*joint, "type");
    if (types.count(type) == 0)
      faults.error(*joint, type, "the type of a joint must be fixed, revolute, continuous, prismatic or ball");
    for (const char* end : {"parent", "child"}) {
      if (!joint->FirstChildElement(end)) faults.error(*joint, "", std::string("needs an element <") + end + ">");
      const bool world = std::string(end) == "parent" && child_text(*joint, end) == "world";
      if (!world) require_name(*joint, end, "link or frame", ends, faults);
    }
    const std::string parent = child_text(*joint, "parent");
    if (!parent.empty() && parent == child_text(*joint, "child"))
      faults.error(*joint, parent, "parent and child must be different links");
    const Element* axis = joint->FirstChildElement("axis");
    if (!axis) {
      if (type == "revolute" || type == "continuous" || type == "prismatic")
        faults.error(*joint, "", "needs an element <axis> with <xyz>");
      continue;
    }
    std::vector<double> xyz(3, 1.0);
    if (const Element* e = axis->FirstChildElement("xyz")) {
      const auto words = words_of(text_of(*e));
      for (std::size_t i = 0; i < 3 && i < words.size(); ++i) to_number(words[i], xyz[i]);
      if (std::hypot(xyz[0], xyz[1], xyz[2]) < 1e-9)
        faults.error(*e, text_of(*e), "an axis must not be zero", "e.g. 0 0 1");
    }
    double lower = -1e16, upper = 1e16;
    if (const Element* limit = axis->FirstChildElement("limit")) {
      to_number(child_text(*limit, "lower"), lower);
      to_number(child_text(*limit, "upper"), upper);
      if (lower > upper) faults.error(*limit, child_text(*limit, "lower"), "lower must not exceed upper");
    }
  }
  return faults.error_count() == before;
}

// Principal moments must be positive and none may exceed the sum of the others: no body has such an inertia.
void check_inertia(const Element& inertial, Faults& faults) {
  const Element* inertia = inertial.FirstChildElement("inertia");
  if (!inertia) return;
  auto value = [&](const char* name, double otherwise) {
    double number = otherwise;
    to_number(child_text(*inertia, name), number);
    return number;
  };
  const double xx = value("ixx", 1), yy = value("iyy", 1), zz = value("izz", 1);
  const double xy = value("ixy", 0), xz = value("ixz", 0), yz = value("iyz", 0);
  Mat3 tensor;
  tensor << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  if (!tensor.allFinite()) return;
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  if (moments[0] > 0 && moments[2] <= moments[0] + moments[1]) return;
  auto text = [](double number) {
    std::ostringstream stream;
    stream << number;
    return stream.str();
  };
  faults.error(*inertia, text(moments[0]) + " " + text(moments[1]) + " " + text(moments[2]),
               "the principal moments of inertia must be positive, none larger than the sum of the other two",
               "a disc has iyy = ixx + izz at most; mind the rounding");
}

void check_links(const Element& model, bool needs_mass, Faults& faults) {
  if (!model.FirstChildElement("link")) faults.error(model, "", "a machine needs at least one <link>");
  for (const Element* link = model.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    const Element* inertial = link->FirstChildElement("inertial");
    if (needs_mass && (!inertial || !inertial->FirstChildElement("mass")))
      faults.error(*link, "", "a moving link needs <inertial> with <mass> and <inertia>");
    if (inertial) check_inertia(*inertial, faults);
    for (const char* kind : {"visual", "collision"})
      for (const Element* e = link->FirstChildElement(kind); e; e = e->NextSiblingElement(kind))
        if (!e->FirstChildElement("geometry") || !e->FirstChildElement("geometry")->FirstChildElement())
          faults.error(*e, "", "needs <geometry> with a shape");
  }
}

void read_linkage(Element& element, scene::Cylinder& cylinder, Faults& faults) {
  cylinder.has_linkage = true;
  Fields(element, faults)
      .vec3("rocker_pin_m", cylinder.p_rocker)
      .required("rocker_pin_m")
      .number("rocker_to_rod_m", cylinder.rocker_rod, {0.01, 10})
      .required("rocker_to_rod_m")
      .number("rocker_to_coupler_m", cylinder.rocker_coupler, {0.01, 10})
      .required("rocker_to_coupler_m")
      .number("coupler_length_m", cylinder.coupler, {0.01, 10})
      .required("coupler_length_m")
      .vec3("coupler_pin_m", cylinder.p_coupler)
      .required("coupler_pin_m")
      .finish();
}

scene::Cylinder read_cylinder(Element& element, const Names& names, Faults& faults) {
  scene::Cylinder cylinder;
  cylinder.name = attribute(element, "name");
  require_attribute_name(element, faults);
  Fields fields(element, faults);
  fields.attribute("name")
      .text("joint", cylinder.joint)
      .required("joint")
      .text("base_link", cylinder.base_link)
      .required("base_link")
      .vec3("base_pin_m", cylinder.p_base)
      .required("base_pin_m")
      .text("rod_link", cylinder.rod_link)
      .required("rod_link")
      .vec3("rod_pin_m", cylinder.p_rod)
      .nested("linkage", [&](Element& linkage) { read_linkage(linkage, cylinder, faults); })
      .whole("count", cylinder.count, {1, 8})
      .number("bore_m", cylinder.bore, {0.005, 1})
      .number("rod_m", cylinder.rod, {0.002, 1})
      .number("pressure_pa", cylinder.pressure, {1e5, 1e8})
      .number("flow_m3_per_s", cylinder.flow, {1e-7, 1})
      .finish();
  if (fields.has("rod_pin_m") == fields.has("linkage"))
    faults.error(element, "", "needs either <rod_pin_m> (acts directly) or <linkage> (acts through a rocker)");
  if (cylinder.rod >= cylinder.bore) faults.error(element, "", "rod_m must be less than bore_m");
  if (cylinder.base_link == cylinder.rod_link && !cylinder.base_link.empty())
    faults.error(element, cylinder.rod_link, "base_link and rod_link must be different links");
  require_name(element, "joint", "joint", names.joints, faults);
  require_name(element, "base_link", "link", names.links, faults);
  require_name(element, "rod_link", "link", names.links, faults);
  return cylinder;
}

void read_pump(Element& element, scene::Pump& pump, Faults& faults) {
  Fields(element, faults)
      .number("flow_m3_per_s", pump.flow, {1e-7, 10})
      .required("flow_m3_per_s")
      .number("power_w", pump.power, {0.1, 1e7})
      .required("power_w")
      .finish();
}

scene::Wheel read_wheel(Element& element, const Names& names, Faults& faults) {
  scene::Wheel wheel;
  Fields(element, faults)
      .attribute("name")
      .text("joint", wheel.joint)
      .required("joint")
      .text("steer_joint", wheel.steer_joint)
      .flag("driven", wheel.driven)
      .number("radius_m", wheel.radius, {0.01, 5})
      .number("width_m", wheel.width, {0.005, 5})
      .number("twin_spacing_m", wheel.twin_spacing, {0, 5})
      .number("stiffness_n_per_m", wheel.stiffness, {100, 1e9})
      .number("damping_n_s_per_m", wheel.damping, {0, 1e8})
      .number("friction", wheel.friction, {0, 3})
      .number("rolling_resistance", wheel.rolling_resistance, {0, 1})
      .finish();
  require_name(element, "joint", "joint", names.joints, faults);
  require_name(element, "steer_joint", "joint", names.joints, faults);
  return wheel;
}

Fields& read_powertrain(Fields& fields, scene::Powertrain& powertrain) {
  return fields.attribute("type")
      .number("max_speed_m_per_s", powertrain.max_speed, {0.01, 50})
      .number("tractive_force_n", powertrain.tractive_force, {0.1, 1e7})
      .number("power_w", powertrain.power, {0.1, 1e7})
      .number("brake_force_n", powertrain.brake_force, {0, 1e7});
}

void read_kind(Element& element, scene::AckermannDrive& drive, Faults& faults) {
  Fields fields(element, faults);
  read_powertrain(fields, drive)
      .number("max_steer_deg", drive.max_steer, {0, 80}, kDegree)
      .number("wheelbase_m", drive.wheelbase, {0.01, 50})
      .number("track_m", drive.track, {0.01, 50})
      .number("steer_rate_deg_per_s", drive.steer_rate, {0.1, 1000}, kDegree)
      .finish();
}

void read_kind(Element& element, scene::DifferentialDrive& drive, Faults& faults) {
  Fields fields(element, faults);
  read_powertrain(fields, drive).number("track_m", drive.track, {0.01, 50}).required("track_m").finish();
}

/// The drive of the kind that `type` names, Ackermann without one.
scene::Drive read_drive(Element& element, Faults& faults) {
  const std::string type = attribute(element, "type");
  // Every kind of the variant by its name, so that a new one is offered here as soon as it has a read_kind.
  const std::vector<scene::Drive> kinds = {scene::AckermannDrive(), scene::DifferentialDrive()};
  std::vector<std::string> names;
  for (scene::Drive drive : kinds) {
    names.push_back(scene::drive_name(drive));
    if (type != names.back() && !(type.empty() && names.size() == 1)) continue;
    std::visit([&](auto& kind) { read_kind(element, kind, faults); }, drive);
    return drive;
  }
  faults.error(element, type, "no drive of this type", suggestion(type, names));
  return {};
}

/// What a kind of drive asks of the wheels; the wheels' joints and links are known.
void check_wheels(const Element& element, const scene::DifferentialDrive&, const scene::Machine& machine,
                  Faults& faults) {
  bool left = false, right = false;
  for (const scene::Wheel& wheel : machine.wheels) {
    if (!wheel.steer_joint.empty())
      faults.error(element, wheel.steer_joint, "a differential drive turns no wheels",
                   "take <steer_joint> out of the wheel; a caster swivels by itself");
    const int joint = machine.joint_index(wheel.joint);
    if (joint < 0 || !wheel.driven) continue;
    const int link = machine.joints[static_cast<std::size_t>(joint)].child;
    (machine.links[static_cast<std::size_t>(link)].X_ML.translation().y() > 0 ? left : right) = true;
  }
  if (!left || !right)
    faults.error(element, "",
                 "a differential drive needs a driven wheel on the left and one on the right (y > 0, y < 0)",
                 "set <driven>true</driven> in wheels of both sides");
}
void check_wheels(const Element&, const scene::AckermannDrive&, const scene::Machine&, Faults&) {}

void read_triangles(Element& element, const std::vector<double>& vertices, const std::vector<double>& corners,
                    scene::Shell& shell, Faults& faults) {
  if (vertices.size() % 3 != 0) faults.error(element, "", "vertices_m must hold 3 numbers a vertex");
  if (corners.size() % 3 != 0) faults.error(element, "", "triangles must hold 3 vertex indices a triangle");
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3)
    shell.vertices.emplace_back(vertices[i], vertices[i + 1], vertices[i + 2]);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    shell.triangles.push_back(
        {static_cast<int>(corners[i]), static_cast<int>(corners[i + 1]), static_cast<int>(corners[i + 2])});
}

/// The solver needs areas, and one side that is the inside: two triangles run along a shared edge in opposite
/// directions.
void check_surface(const Element& element, const scene::Shell& shell, Faults& faults) {
  const auto named = [&](std::size_t n) {
    const std::array<int, 3>& t = shell.triangles[n];
    return std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]);
  };
  for (std::size_t n = 0; n < shell.triangles.size(); ++n)
    if (!(shell.area_vector(n).norm() > 1e-10))
      faults.error(element, named(n), "triangle " + std::to_string(n) + " has no area",
                   "remove it or mend its corners");
  if (const auto clash = geometry::find_winding_clash(shell))
    faults.error(element, named(clash->second),
                 "triangles " + std::to_string(clash->first) + " and " + std::to_string(clash->second) +
                     " are wound against each other along their edge",
                 "wind the whole shell alike: counter-clockwise as seen from the inside");
}

scene::Shell read_shell(Element& element, const Names& names, Faults& faults) {
  scene::Shell shell;
  shell.name = attribute(element, "name");
  require_attribute_name(element, faults);
  std::string mesh;
  std::vector<double> vertices, corners;
  Fields fields(element, faults);
  fields.attribute("name")
      .text("link", shell.link)
      .required("link")
      .text("mesh", mesh)
      .list("vertices_m", vertices, {-1000, 1000})
      .list("triangles", corners, {0, 1e6})
      .number("half_thickness_m", shell.half_thickness, {1e-4, 1})
      .number("friction_share", shell.friction_share, {0, 2})
      .number("adhesion_share", shell.adhesion_share, {0, 2})
      .finish();
  require_name(element, "link", "link", names.links, faults);
  const bool inline_given = fields.has("vertices_m") && fields.has("triangles");
  if (fields.has("mesh") == inline_given)
    faults.error(element, "", "needs either <mesh> or <vertices_m> with <triangles>");
  if (inline_given) read_triangles(element, vertices, corners, shell, faults);
  std::string path;
  if (Element* child = fields.child("mesh"); child && resolve_mesh(*child, path, faults))
    read_shell_mesh(path, *child, shell, faults);
  for (const auto& triangle : shell.triangles) {
    const int count = static_cast<int>(shell.vertices.size());
    const bool inside = std::all_of(triangle.begin(), triangle.end(), [&](int i) { return i >= 0 && i < count; });
    if (!inside || triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[0] == triangle[2]) {
      faults.error(element,
                   std::to_string(triangle[0]) + " " + std::to_string(triangle[1]) + " " + std::to_string(triangle[2]),
                   "a triangle must name three different vertices from 0 to " + std::to_string(count - 1));
      return shell;
    }
  }
  if (shell.triangles.empty() && (inline_given || !path.empty())) faults.error(element, "", "holds no triangle");
  check_surface(element, shell, faults);
  return shell;
}

scene::Bucket read_bucket(Element& element, const Names& names, Faults& faults) {
  scene::Bucket bucket;
  Fields(element, faults)
      .attribute("name")
      .text("link", bucket.link)
      .required("link")
      .text("shell", bucket.shell)
      .required("shell")
      .number("capacity_m3", bucket.capacity, {1e-4, 100})
      .number("width_m", bucket.width, {0.01, 20})
      .vec3("tip_m", bucket.p_tip)
      .required("tip_m")
      .direction("cut_direction", bucket.cut_direction)
      .direction("opening", bucket.opening)
      .finish();
  require_name(element, "link", "link", names.links, faults);
  require_name(element, "shell", "navvy:shell", names.shells, faults);
  return bucket;
}

scene::Bed read_bed(Element& element, const Names& names, Faults& faults) {
  scene::Bed bed;
  Fields(element, faults)
      .attribute("name")
      .text("link", bed.link)
      .required("link")
      .text("shell", bed.shell)
      .required("shell")
      .text("joint", bed.joint)
      .required("joint")
      .number("capacity_m3", bed.capacity, {1e-4, 1000})
      .finish();
  require_name(element, "link", "link", names.links, faults);
  require_name(element, "shell", "navvy:shell", names.shells, faults);
  require_name(element, "joint", "joint", names.joints, faults);
  const auto type = names.joint_type.find(bed.joint);
  if (type != names.joint_type.end() && type->second != "revolute")
    faults.error(*element.FirstChildElement("joint"), type->second, "a bed tips on a revolute joint",
                 "name the joint of its hinge");
  return bed;
}

/// A bed is a shell on its link, and its joint tips that link; unknown names have been told by read_bed.
void check_bed(Element& element, const scene::Machine& machine, std::size_t index, Faults& faults) {
  const scene::Bed& bed = machine.beds[index];
  if (index > 0) faults.error(element, "", "a machine has one bed", "make the second one a machine of its own");
  for (const scene::Shell& shell : machine.shells)
    if (shell.name == bed.shell && shell.link != bed.link)
      faults.error(element, bed.link, "its shell '" + bed.shell + "' is on link '" + shell.link + "'",
                   "name the link of the shell");
  const int joint = machine.joint_index(bed.joint);
  if (joint < 0) return;
  const int child = machine.joints[static_cast<std::size_t>(joint)].child;
  const std::string tipped = child < 0 ? "" : machine.links[static_cast<std::size_t>(child)].name;
  if (tipped != bed.link)
    faults.error(element, bed.joint, "the joint moves link '" + tipped + "', not the bed's",
                 "name the joint that tips it");
}

void read_arm(Element& element, const Names& names, scene::Machine& machine, Faults& faults) {
  Fields(element, faults)
      .text("swing_joint", machine.arm.swing)
      .text("boom_joint", machine.arm.boom)
      .text("stick_joint", machine.arm.stick)
      .text("bucket_joint", machine.arm.bucket)
      .finish();
  for (const char* role : {"swing_joint", "boom_joint", "stick_joint", "bucket_joint"})
    require_name(element, role, "joint", names.joints, faults);
}

}  // namespace

void read_initial_position(Element& element, scene::Machine& machine, Faults& faults) {
  const std::string name = attribute(element, "name");
  double angle = 0, length = 0;
  Fields fields(element, faults);
  fields.attribute("name")
      .number("initial_deg", angle, {-3600, 3600}, kDegree)
      .number("initial_m", length, {-1000, 1000})
      .finish();
  if (fields.has("initial_deg") == fields.has("initial_m")) {
    faults.error(element, "", "needs either <initial_deg> or <initial_m>");
    return;
  }
  const int index = machine.joint_index(name);
  if (index < 0) {
    std::vector<std::string> names;
    for (const scene::Joint& joint : machine.joints) names.push_back(joint.name);
    faults.error(element, name, "no joint of this name in the machine", suggestion(name, names));
    return;
  }
  scene::Joint& joint = machine.joints[static_cast<std::size_t>(index)];
  const bool turns = joint.type == scene::Joint::Type::kRevolute;
  if (!turns && joint.type != scene::Joint::Type::kPrismatic)
    faults.error(element, name, "only revolute and prismatic joints have a position");
  else if (turns != fields.has("initial_deg"))
    faults.error(element, name, turns ? "a revolute joint needs <initial_deg>" : "a prismatic joint needs <initial_m>");
  joint.initial = turns ? angle : length;
  if (joint.has_limits && (joint.initial < joint.lower - 1e-9 || joint.initial > joint.upper + 1e-9))
    faults.error(element, text_of(*element.FirstChildElement()), "must lie within the limits of the joint");
}

scene::Machine read_machine(Element& model, bool sdf_sound, Faults& faults) {
  scene::Machine machine;
  machine.file = Document::of(model).file();
  machine.name = attribute(model, "name");
  const Names names = names_of(model);
  bool kinematic = false;
  if (Element* engine = model.FirstChildElement("navvy:engine")) {
    const std::string value = text_of(*engine);
    kinematic = value == "kinematic";
    if (!kinematic && value != "dynamic") faults.error(*engine, value, "must be dynamic or kinematic");
  }
  if (model.Attribute("placement_frame"))
    faults.error(model, attribute(model, "placement_frame"), "placement_frame is not supported", "remove it");
  const std::string is_static = child_text(model, "static");
  const std::size_t before = faults.error_count();
  check_links(model, !kinematic && is_static != "true" && is_static != "1", faults);
  check_joints(model, names, faults);
  if (sdf_sound && faults.error_count() == before) read_sdf_model(model, machine, faults);
  const bool has_joints = !machine.links.empty();
  machine.kinematic = kinematic;
  std::vector<Element*> beds;
  const Element* drive = nullptr;

  for (Element* e = model.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    if (kind == "navvy:cylinder") machine.cylinders.push_back(read_cylinder(*e, names, faults));
    if (kind == "navvy:wheel") machine.wheels.push_back(read_wheel(*e, names, faults));
    if (kind == "navvy:shell") machine.shells.push_back(read_shell(*e, names, faults));
    if (kind == "navvy:bucket") machine.buckets.push_back(read_bucket(*e, names, faults));
    if (kind == "navvy:bed") {
      machine.beds.push_back(read_bed(*e, names, faults));
      beds.push_back(e);
    }
    if (kind == "navvy:arm") read_arm(*e, names, machine, faults);
    if (kind == "navvy:joint" && has_joints) read_initial_position(*e, machine, faults);
    if (kind == "navvy:pump") {
      machine.has_pump = true;
      read_pump(*e, machine.pump, faults);
      if (!model.FirstChildElement("navvy:cylinder"))
        faults.error(*e, "", "a pump needs cylinders to feed", "add <navvy:cylinder>, or take the pump out");
      if (kinematic)
        faults.warning(*e, "", "a kinematic machine moves as told and has no use for a pump", "take it out");
    }
    if (kind == "navvy:drive") {
      machine.has_drive = true;
      machine.drive = read_drive(*e, faults);
      drive = e;
      if (!model.FirstChildElement("navvy:wheel"))
        faults.error(*e, "", "a drive needs wheels", "add <navvy:wheel> with <driven>true</driven>");
    }
  }
  for (std::size_t i = 0; i < beds.size(); ++i) check_bed(*beds[i], machine, i, faults);
  if (drive != nullptr && has_joints && !machine.wheels.empty())
    std::visit([&](const auto& kind) { check_wheels(*drive, kind, machine, faults); }, machine.drive);
  return machine;
}

}  // namespace navvy::scene_io
