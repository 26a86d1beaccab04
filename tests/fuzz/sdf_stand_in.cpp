// SPDX-License-Identifier: Apache-2.0
// Replaces scene_io/sdf_model.cpp in targets that read without libsdformat, which costs 80 ms per
// model under the sanitizers: the linker takes this function instead of the library's. Links,
// joints and meshes come straight from the element tree. Frames and poses are not resolved and
// inertias not rotated, as none of our readers needs them. loader_fuzz uses libsdformat itself.
#include <algorithm>
#include <string>
#include <vector>

#include "scene_io/element_reader.h"
#include "scene_io/mesh_path.h"
#include "scene_io/sdf_model.h"

namespace navvy::scene_io {

namespace {

/// Returns the link that a link or frame is attached to, or "".
std::string link_of(const Element& model, std::string name) {
  for (int hops = 0; hops < 8; ++hops) {
    const Element* frame = named_child(model, "frame", name);
    if (frame == nullptr)
      return name == "world" || named_child(model, "link", name) != nullptr ? name : "";
    name = attribute(*frame, "attached_to");
  }
  return "";
}

Pose pose_of(const Element& element) {
  Pose X = Pose::Identity();
  // Faults that check_sdf has reported already.
  Faults faults;
  if (const Element* pose = element.FirstChildElement("pose")) read_pose(*pose, X, faults);
  return X;
}

double number_in(const Element* element, const char* name, double otherwise) {
  double value = otherwise;
  if (element != nullptr) to_number(child_text(*element, name), value);
  return value;
}

/// Our own reader reads meshes; libsdformat reads other shapes.
void check_meshes(const Element& link, Faults& faults) {
  for (const char* kind : {"visual", "collision"})
    for (const Element* shape = link.FirstChildElement(kind); shape;
         shape = shape->NextSiblingElement(kind)) {
      const Element* at = shape;
      for (const char* name : {"geometry", "mesh", "uri"})
        at = at != nullptr ? at->FirstChildElement(name) : nullptr;
      std::string path;
      if (at != nullptr && resolve_mesh(*at, path, faults))
        check_mesh(*at, path, std::string(kind) == "collision", faults);
    }
}

scene::Joint joint_of(const Element& element) {
  using Type = scene::Joint::Type;
  scene::Joint joint;
  joint.name = attribute(element, "name");
  const std::string type = attribute(element, "type");
  if (type == "revolute" || type == "continuous") joint.type = Type::kRevolute;
  if (type == "prismatic") joint.type = Type::kPrismatic;
  if (type == "ball") joint.type = Type::kBall;
  joint.X_LcJ = pose_of(element);
  const Element* axis = element.FirstChildElement("axis");
  if (axis == nullptr) return joint;
  std::vector<double> xyz;
  Faults faults;
  if (const Element* e = axis->FirstChildElement("xyz");
      e != nullptr && read_numbers(*e, 3, {-1e3, 1e3}, xyz, faults))
    joint.axis = Vec3(xyz[0], xyz[1], xyz[2]).normalized();
  const Element* limit = axis->FirstChildElement("limit");
  joint.lower = number_in(limit, "lower", -1e16);
  joint.upper = number_in(limit, "upper", 1e16);
  joint.has_limits = type != "continuous" && joint.lower > -1e15 && joint.upper < 1e15;
  return joint;
}

}  // namespace

bool read_sdf_model(const Element& model, scene::Machine& machine, std::vector<Gearbox>& gearboxes,
                    Faults& faults) {
  const std::size_t before = faults.error_count();
  ++faults.work.models;
  std::vector<std::string> parents, children;
  std::vector<const Element*> joints;
  for (const Element* e = model.FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) {
    if (attribute(*e, "type") == "gearbox") {
      gearboxes.push_back({attribute(*e, "name"), link_of(model, child_text(*e, "parent")),
                           link_of(model, child_text(*e, "child")),
                           child_text(*e, "gearbox_reference_body"),
                           number_in(e, "gearbox_ratio", 1)});
      continue;
    }
    joints.push_back(e);
    parents.push_back(link_of(model, child_text(*e, "parent")));
    children.push_back(link_of(model, child_text(*e, "child")));
  }
  const auto add = [&](const std::string& name) {
    const Element& element = *named_child(model, "link", name);
    scene::Link link;
    link.name = name;
    link.X_ML = pose_of(element);
    link.mass = number_in(element.FirstChildElement("inertial"), "mass", 1);
    check_meshes(element, faults);
    machine.links.push_back(link);
  };
  // The base is the first link that no joint moves; each joint below it moves the next link.
  for (const Element* e = model.FirstChildElement("link"); e && machine.links.empty();
       e = e->NextSiblingElement("link"))
    if (std::find(children.begin(), children.end(), attribute(*e, "name")) == children.end())
      add(attribute(*e, "name"));
  for (std::size_t i = 0; i < machine.links.size(); ++i)
    for (std::size_t k = 0; k < joints.size(); ++k) {
      if (parents[k] != machine.links[i].name || children[k].empty() || children[k] == "world")
        continue;
      scene::Joint joint = joint_of(*joints[k]);
      if (machine.link_index(children[k]) >= 0) {
        scene::LoopJoint loop;
        loop.name = joint.name;
        loop.type = static_cast<scene::LoopJoint::Type>(joint.type);
        loop.parent = static_cast<int>(i);
        loop.child = machine.link_index(children[k]);
        loop.axis = joint.axis;
        machine.loops.push_back(loop);
        continue;
      }
      joint.parent = static_cast<int>(i);
      joint.child = static_cast<int>(machine.links.size());
      machine.joints.push_back(joint);
      add(children[k]);
    }
  std::size_t links = 0, to_world = 0;
  for (const Element* e = model.FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
    ++links;
  to_world = static_cast<std::size_t>(std::count(parents.begin(), parents.end(), "world"));
  if (machine.links.empty() || machine.links.size() != links ||
      machine.joints.size() + machine.loops.size() + to_world != joints.size())
    faults.error(model, "", "the joints form no tree");
  const std::string is_static = child_text(model, "static");
  machine.fixed_base = to_world > 0 || is_static == "true" || is_static == "1";
  return faults.error_count() == before;
}

}  // namespace navvy::scene_io
