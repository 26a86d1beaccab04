// SPDX-License-Identifier: Apache-2.0
#include "scene_io/machine_reader.h"

#include "scene_io/channel_reader.h"
#include "scene_io/derived_parts.h"
#include "scene_io/drive_reader.h"
#include "scene_io/fields.h"
#include "scene_io/hydraulics_reader.h"
#include "scene_io/link_rules.h"
#include "scene_io/machine_names.h"
#include "scene_io/sdf_model.h"
#include "scene_io/shell_reader.h"

namespace navvy::scene_io {

namespace {

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
  const Element* joint = element.FirstChildElement("joint");
  const auto type = names.joint_type.find(bed.joint);
  // A joint without a name is none that was meant.
  if (joint != nullptr && type != names.joint_type.end() && type->second != "revolute")
    faults.error(*joint, type->second, "a bed tips on a revolute joint",
                 "name the joint of its hinge");
  return bed;
}

/// A bed is a shell on its link, and its joint tips that link; unknown names have been told by
/// read_bed.
void check_bed(Element& element, const scene::Machine& machine, std::size_t index, Faults& faults) {
  const scene::Bed& bed = machine.beds[index];
  if (index > 0)
    faults.error(element, "", "a machine has one bed", "make the second one a machine of its own");
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

/// A plane carries what stands on it, for ever and everywhere: only the ground's rock can be one.
void check_planes(const Element& model, const scene::Machine& machine, Faults& faults) {
  for (std::size_t l = 0; l < machine.links.size(); ++l)
    for (const scene::Collision& collision : machine.links[l].collisions) {
      if (collision.geometry.kind != scene::Geometry::Kind::kPlane) continue;
      const Element* link = named_child(model, "link", machine.links[l].name);
      const Element& at = link ? *link : model;
      if (l > 0 || !machine.fixed_base)
        faults.error(at, collision.name, "a plane cannot move: it is the rock under the ground",
                     "use a <box>, or make the model <static>true</static>");
    }
}

/// Stops of ball joints.
void read_balls(Element& model, scene::Machine& machine, Faults& faults) {
  for (Element* of = model.FirstChildElement("joint"); of; of = of->NextSiblingElement("joint")) {
    Element* element = of->FirstChildElement("navvy:ball");
    if (element == nullptr) continue;
    double cone = kPi, twist = kPi;
    Fields fields(*element, faults);
    fields.number("cone_deg", cone, {0.1, 180}, kDegree)
        .number("twist_deg", twist, {0.1, 180}, kDegree)
        .finish();
    if (attribute(*of, "type") != "ball")
      faults.error(*element, attribute(*of, "type"), "only a ball joint has a cone and a twist",
                   "give limits in its <axis>");
    else if (!fields.has("cone_deg") && !fields.has("twist_deg"))
      faults.error(*element, "", "needs <cone_deg>, <twist_deg> or both",
                   "leave it out for a ball that turns freely");
    const int joint = machine.joint_index(attribute(*of, "name"));
    if (joint < 0) continue;
    machine.joints[static_cast<std::size_t>(joint)].cone = cone;
    machine.joints[static_cast<std::size_t>(joint)].twist = twist;
  }
}

/// Brakes of joints that turn or slide; one that spins a wheel has the drive's.
void read_brakes(Element& model, scene::Machine& machine, Faults& faults) {
  using Type = scene::Joint::Type;
  for (Element* of = model.FirstChildElement("joint"); of; of = of->NextSiblingElement("joint")) {
    Element* element = of->FirstChildElement("navvy:brake");
    if (element == nullptr) continue;
    double torque = 0, force = 0;
    Fields fields(*element, faults);
    fields.number("torque_nm", torque, {1e-3, 1e9}).number("force_n", force, {1e-3, 1e9}).finish();
    const std::string name = attribute(*of, "name");
    const int joint = machine.joint_index(name);
    if (joint < 0) continue;
    scene::Joint& about = machine.joints[static_cast<std::size_t>(joint)];
    const bool turns = about.type == Type::kRevolute;
    if (!turns && about.type != Type::kPrismatic)
      faults.error(*element, attribute(*of, "type"), "a brake holds a joint that turns or slides",
                   "take it out");
    else if (fields.has("torque_nm") != turns || fields.has("force_n") == turns)
      faults.error(
          *element, "",
          turns ? "a revolute joint needs <torque_nm>" : "a prismatic joint needs <force_n>",
          "what the brake holds at most");
    for (const scene::Wheel& wheel : machine.wheels)
      if (wheel.joint == name)
        faults.error(
            *element, name, "this joint spins a wheel, which the drive brakes",
            "take it out; brake_force_n of <navvy:drive> and the input drive/brake hold wheels");
    about.brake = turns ? torque : force;
  }
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
    faults.error(element, name, "no joint of this name in the machine",
                 faults.nearest(name, names));
    return;
  }
  scene::Joint& joint = machine.joints[static_cast<std::size_t>(index)];
  const bool turns = joint.type == scene::Joint::Type::kRevolute;
  if (!turns && joint.type != scene::Joint::Type::kPrismatic)
    faults.error(element, name, "only revolute and prismatic joints have a position");
  else if (turns != fields.has("initial_deg"))
    faults.error(
        element, name,
        turns ? "a revolute joint needs <initial_deg>" : "a prismatic joint needs <initial_m>");
  joint.initial = turns ? angle : length;
  if (joint.has_limits &&
      (joint.initial < joint.lower - 1e-9 || joint.initial > joint.upper + 1e-9))
    faults.error(element, text_of(*element.FirstChildElement()),
                 "must lie within the limits of the joint");
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
    if (engine->FirstChildElement() != nullptr)
      faults.error(*engine, engine->FirstChildElement()->Name(),
                   "says what moves the machine, dynamic or kinematic",
                   "the engine of a drive is <engine> inside <navvy:drive>");
    else if (!kinematic && value != "dynamic")
      faults.error(*engine, value, "must be dynamic or kinematic");
  }
  if (model.Attribute("placement_frame"))
    faults.error(model, attribute(model, "placement_frame"), "placement_frame is not supported",
                 "remove it");
  const std::string is_static = child_text(model, "static");
  const std::size_t before = faults.error_count();
  check_links(model, !kinematic && is_static != "true" && is_static != "1", faults);
  check_joints(model, names, faults);
  if (sdf_sound && faults.error_count() == before) read_sdf_model(model, machine, faults);
  machine.kinematic = kinematic;
  read_balls(model, machine, faults);
  read_extensions(model, names, machine, faults);
  read_brakes(model, machine, faults);
  for (scene::Link& link : machine.links)
    if (const Element* of = named_child(model, "link", link.name))
      if (const Element* material = of->FirstChildElement("navvy:material")) {
        link.material = {text_of(*material), place_of(*material).line};
        if (words_of(link.material.name).size() != 1)
          faults.error(*material, link.material.name, "must be one word", "e.g. steel");
      }
  // Last, as wheels and shells decide which links touch by something else.
  derive_parts(model, machine, faults);
  check_planes(model, machine, faults);
  return machine;
}

void read_traversability(Element& element, scene::Traversability& limits, Faults& faults) {
  limits.given = true;
  Fields(element, faults)
      .number("slope_deg", limits.slope, {1, 89}, kDegree)
      .number("step_m", limits.step_height, {0.001, 100})
      .number("roughness_m", limits.roughness, {0.001, 100})
      .number("window_m", limits.window, {0.01, 10})
      .finish();
}

void read_extensions(Element& model, const Names& names, scene::Machine& machine, Faults& faults) {
  const bool has_joints = !machine.links.empty();
  std::vector<Element*> beds;
  const Element* drive = nullptr;

  for (Element* e = model.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    if (kind == "navvy:cylinder") machine.cylinders.push_back(read_cylinder(*e, names, faults));
    if (kind == "navvy:wheel") machine.wheels.push_back(read_wheel(*e, names, faults));
    if (kind == "navvy:track") machine.wheels.push_back(read_track(*e, names, faults));
    if (kind == "navvy:shell") machine.shells.push_back(read_shell(*e, names, faults));
    if (kind == "navvy:bucket") machine.buckets.push_back(read_bucket(*e, names, faults));
    if (kind == "navvy:bed") {
      machine.beds.push_back(read_bed(*e, names, faults));
      beds.push_back(e);
    }
    if (kind == "navvy:arm") read_arm(*e, names, machine, faults);
    if (kind == "navvy:encoder") read_encoder(*e, names, machine, faults);
    if (kind == "navvy:traversability") read_traversability(*e, machine.traversability, faults);
    if (kind == "navvy:joint" && has_joints) read_initial_position(*e, machine, faults);
    if (kind == "navvy:pump") {
      machine.has_pump = true;
      read_pump(*e, machine.pump, faults);
      if (!model.FirstChildElement("navvy:cylinder"))
        faults.error(*e, "", "a pump needs cylinders to feed",
                     "add <navvy:cylinder>, or take the pump out");
      if (machine.kinematic)
        faults.warning(*e, "", "a kinematic machine moves as told and has no use for a pump",
                       "take it out");
    }
    if (kind == "navvy:drive") {
      machine.has_drive = true;
      machine.drive = read_drive(*e, faults);
      drive = e;
      if (!model.FirstChildElement("navvy:wheel") && !model.FirstChildElement("navvy:track"))
        faults.error(*e, "", "a drive needs wheels",
                     "add <navvy:wheel> with <driven>true</driven>, or <navvy:track>");
    }
  }
  // After the arm, wherever it stands in the file.
  if (Element* levers = model.FirstChildElement("navvy:levers"))
    read_levers(*levers, machine, faults);
  if (has_joints) check_tracks(model, machine, faults);
  for (std::size_t i = 0; i < beds.size(); ++i) check_bed(*beds[i], machine, i, faults);
  if (drive != nullptr && has_joints && !machine.wheels.empty())
    check_wheels(*drive, machine, faults);
}

}  // namespace navvy::scene_io
