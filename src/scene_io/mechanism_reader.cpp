// SPDX-License-Identifier: Apache-2.0
#include "scene_io/mechanism_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "scene/close_loops.h"
#include "scene_io/element_reader.h"
#include "scene_io/schema.h"

namespace navvy::scene_io {

namespace {

using scene::Joint;
using scene::JointGear;

// [m] largest gap of a loop at the start. Files round poses to six digits.
constexpr double kOpen = 1e-5;
// Cosine above which two axes are the same line.
constexpr double kParallel = 0.9999;
// Beyond it an effort stands for no limit.
constexpr double kNoEffort = 1e8;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

bool moves(const Joint& joint) {
  return joint.type == Joint::Type::kRevolute || joint.type == Joint::Type::kPrismatic;
}

const Element& joint_element(const Element& model, const std::string& name) {
  const Element* element = named_child(model, "joint", name);
  return element != nullptr ? *element : model;
}

std::vector<std::string> moving_joints(const scene::Machine& machine) {
  std::vector<std::string> names;
  for (const Joint& joint : machine.joints)
    if (moves(joint)) names.push_back(joint.name);
  return names;
}

/// Reads the ratios of one machine.
class GearReader {
 public:
  GearReader(const Element& model, scene::Machine& machine, Faults& faults)
      : model_(model), machine_(machine), faults_(faults) {}

  void read_mimics() {
    for (const Element* joint = model_.FirstChildElement("joint"); joint;
         joint = joint->NextSiblingElement("joint"))
      if (const Element* axis = joint->FirstChildElement("axis"))
        if (const Element* mimic = axis->FirstChildElement("mimic")) read_mimic(*joint, *mimic);
  }

  void read(const Gearbox& box) {
    const Element& element = joint_element(model_, box.name);
    const Shaft one = shaft(box, element, box.parent, box.parent_axis),
                other = shaft(box, element, box.child, box.child_axis);
    if (one.joint < 0 || other.joint < 0) return;
    // Both angles have the sign of their joint's position where `sign` is 1.
    JointGear gear{box.name, other.joint, one.joint, -box.ratio * one.sign * other.sign, 0};
    // Either side may follow: in a train of gears, each shaft follows one other.
    if (follows(gear.follower) && !follows(gear.leader))
      gear = {box.name, one.joint, other.joint, 1 / gear.ratio, 0};
    add(gear, element);
  }

 private:
  /// Joint on which a shaft of a gearbox turns.
  struct Shaft {
    int joint = -1;
    double sign = 1;
  };

  bool follows(int joint) const {
    return std::any_of(machine_.gears.begin(), machine_.gears.end(),
                       [&](const JointGear& gear) { return gear.follower == joint; });
  }

  /// Reads a number below <mimic>; returns false after an error.
  bool read_number(const Element& mimic, const char* name, double& value) {
    const Element* element = mimic.FirstChildElement(name);
    if (element == nullptr) return true;
    std::vector<double> numbers;
    if (!read_numbers(*element, 1, {-1e9, 1e9}, numbers, faults_)) return false;
    value = numbers[0];
    return true;
  }

  void read_mimic(const Element& joint, const Element& mimic) {
    for (const Element* e = mimic.FirstChildElement(); e; e = e->NextSiblingElement())
      if (const std::string name = e->Name();
          name != "multiplier" && name != "offset" && name != "reference")
        faults_.error(*e, text_of(*e), "unknown element in <mimic>",
                      faults_.nearest(name, {"multiplier", "offset", "reference"}));
    if (const std::string axis = attribute(mimic, "axis"); !axis.empty() && axis != "axis")
      faults_.error(mimic, axis, "joints have one axis", "write axis=\"axis\", or leave it out");
    double ratio = 1, offset = 0, reference = 0;
    const bool read = read_number(mimic, "multiplier", ratio) &&
                      read_number(mimic, "offset", offset) &&
                      read_number(mimic, "reference", reference);
    const std::string name = attribute(joint, "name"), leader = attribute(mimic, "joint");
    const int follower = machine_.joint_index(name);
    if (follower < 0 || !moves(machine_.joints[at(follower)])) {
      faults_.error(
          mimic, name,
          follower < 0 ? "a joint that closes a loop has no position that could follow"
                       : "only joints that turn or slide can follow another one",
          follower < 0 ? "write it before the other joint into its link" : "remove <mimic>");
      return;
    }
    if (leader == name) {
      faults_.error(mimic, leader, "a joint cannot follow itself", "name another joint");
      return;
    }
    if (!require_name(mimic, leader, "joint of this name that turns or slides in the model",
                      moving_joints(machine_), faults_) ||
        !read)
      return;
    if (ratio == 0) {
      faults_.error(child_or_self(mimic, "multiplier"), "0",
                    "the ratio of two joints must not be 0",
                    "make it a joint of type fixed if it is to stand still");
      return;
    }
    add({name, follower, machine_.joint_index(leader), ratio, offset - ratio * reference}, mimic);
  }

  /// Returns the joint on which the shaft `link` of a gearbox turns; none after an error.
  Shaft shaft(const Gearbox& box, const Element& element, const std::string& link,
              const Vec3& axis) {
    const Element& place = child_or_self(element, "gearbox_reference_body");
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
      const Joint& joint = machine_.joints[j];
      if (joint.parent < 0 || joint.type != Joint::Type::kRevolute) continue;
      const std::string &from = machine_.links[at(joint.parent)].name,
                        &to = machine_.links[at(joint.child)].name;
      if (!((from == box.reference && to == link) || (from == link && to == box.reference)))
        continue;
      const Vec3 own =
          machine_.links[at(joint.child)].X_ML.linear() * joint.X_LcJ.linear() * joint.axis;
      const double along = own.dot(axis);
      if (std::abs(along) < kParallel) {
        faults_.error(
            element, joint.name,
            "the gearbox's axis is not that of this joint, on which '" + link +
                "' turns against '" + box.reference + "'",
            "give <axis> the joint's direction for the parent, and <axis2> for the child");
        return {};
      }
      // The joint of the reference body turns the other way, seen from it.
      return {static_cast<int>(j), (along > 0 ? 1.0 : -1.0) * (from == link ? -1.0 : 1.0)};
    }
    faults_.error(place, box.reference,
                  "no joint of type revolute or continuous connects it with '" + link + "'",
                  "name the link on which both shafts of the gearbox turn");
    return {};
  }

  void add(const JointGear& gear, const Element& element) {
    const std::string& name = machine_.joints[at(gear.follower)].name;
    for (const JointGear& other : machine_.gears)
      if (other.follower == gear.follower) {
        faults_.error(
            element, name,
            "this joint follows joint '" + machine_.joints[at(other.leader)].name + "' already",
            "remove one of the two ratios");
        return;
      }
    // Every joint follows one other at most, so the way up ends or comes back.
    int up = gear.leader;
    for (bool found = true; found && up != gear.follower;) {
      found = false;
      for (const JointGear& other : machine_.gears)
        if (other.follower == up) {
          up = other.leader;
          found = true;
          break;
        }
    }
    if (up == gear.follower) {
      faults_.error(element, name, "the joints follow each other in a circle",
                    "remove one of the ratios");
      return;
    }
    machine_.gears.push_back(gear);
  }

  const Element& model_;
  scene::Machine& machine_;
  Faults& faults_;
};

/// Returns for each joint whether it is part of a closed loop.
std::vector<char> joints_in_loops(const scene::Machine& machine) {
  std::vector<char> out(machine.joints.size(), 0);
  for (const scene::LoopJoint& loop : machine.loops) {
    // Joints above both ends are not part of the loop: they are met twice.
    std::vector<int> met(machine.joints.size(), 0);
    for (int link : {loop.parent, loop.child})
      // The child of joint i is link i + 1.
      while (link > 0) {
        ++met[at(link - 1)];
        link = machine.joints[at(link - 1)].parent;
      }
    for (std::size_t j = 0; j < met.size(); ++j)
      if (met[j] == 1) out[j] = 1;
  }
  return out;
}

/// Reports extension elements that name a joint that closes a loop.
void check_names(Element& element, const std::set<std::string>& closing, Faults& faults) {
  for (Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string name =
        std::strcmp(e->Name(), "navvy:joint") == 0 ? attribute(*e, "name") : text_of(*e);
    const bool refers =
        std::strcmp(e->Name(), "navvy:joint") == 0 || schema().refers_to_part(e->Name());
    if (refers && closing.count(name) > 0)
      faults.error(*e, name, "this joint closes a loop: it has no position of its own",
                   "write it in the file before the other joint into its child link");
    if (is_extension(*e)) check_names(*e, closing, faults);
  }
}

}  // namespace

void read_gears(const Element& model, const std::vector<Gearbox>& gearboxes,
                scene::Machine& machine, Faults& faults) {
  GearReader reader(model, machine, faults);
  reader.read_mimics();
  for (const Gearbox& box : gearboxes) reader.read(box);
}

namespace {

/// Reports roles of an arm or a bed whose joint another one moves.
void check_roles(const Element& model, const scene::Machine& machine, const std::string& follower,
                 const std::string& rule, Faults& faults) {
  const scene::Arm& arm = machine.arm;
  for (const std::string* role : {&arm.swing, &arm.boom, &arm.stick, &arm.bucket})
    if (*role == follower)
      faults.error(child_or_self(model, "navvy:arm"), follower, "this joint " + rule,
                   "name that joint");
  for (const scene::Bed& bed : machine.beds)
    if (bed.joint == follower)
      faults.error(child_or_self(model, "navvy:bed"), follower, "this joint " + rule,
                   "name that joint");
}

}  // namespace

void finish_mechanisms(Element& model, scene::Machine& machine, Faults& faults) {
  const std::vector<char> in_loop = joints_in_loops(machine);
  const auto has_cylinder = [&](const Joint& joint) {
    return std::any_of(machine.cylinders.begin(), machine.cylinders.end(),
                       [&](const scene::Cylinder& c) { return c.joint == joint.name; });
  };
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    Joint& joint = machine.joints[j];
    if (!moves(joint) || joint.has_passive) continue;
    joint.passive = joint.stiffness > 0 ||
                    (in_loop[j] != 0 && joint.effort >= kNoEffort && !has_cylinder(joint));
  }
  for (const JointGear& gear : machine.gears) {
    Joint& joint = machine.joints[at(gear.follower)];
    const Element& element = joint_element(model, joint.name);
    const std::string rule =
        "follows joint '" + machine.joints[at(gear.leader)].name + "', which alone moves it";
    if (joint.has_passive && !joint.passive)
      faults.error(child_or_self(element, "navvy:passive"), "false", rule, "remove it");
    if (has_cylinder(joint))
      faults.error(element, joint.name, rule, "put its <navvy:cylinder> on that joint");
    check_roles(model, machine, joint.name, rule, faults);
    joint.passive = true;
  }
  for (const Joint& joint : machine.joints)
    if (joint.has_passive && !moves(joint))
      faults.error(child_or_self(joint_element(model, joint.name), "navvy:passive"), joint.name,
                   "only joints that turn or slide can be passive", "remove it");
  std::set<std::string> closing;
  for (const scene::LoopJoint& loop : machine.loops) closing.insert(loop.name);
  if (!closing.empty()) check_names(model, closing, faults);
}

void close_at_start(Element& parent, const std::vector<scene::InitialPosition>& positions,
                    scene::Machine& machine, Faults& faults) {
  if (machine.gears.empty() && machine.loops.empty()) return;
  const std::vector<Element*> elements = children_of(parent, {"navvy:joint"});
  std::vector<double> q;
  std::vector<char> held;
  for (const Joint& joint : machine.joints) {
    q.push_back(joint.initial);
    held.push_back(joint.passive ? 0 : 1);
  }
  std::vector<const Element*> given(machine.joints.size(), nullptr);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (const int joint = machine.joint_index(positions[i].joint); joint >= 0) {
      given[at(joint)] = elements.at(i);
      held[at(joint)] = 1;
    }
  const double gap = scene::close_loops(machine, held, q);
  for (const JointGear& gear : machine.gears) {
    const double is = q[at(gear.follower)], was = machine.joints[at(gear.follower)].initial;
    if (given[at(gear.follower)] != nullptr && std::abs(is - was) > 1e-6 * (1 + std::abs(is)))
      faults.error(*given[at(gear.follower)],
                   text_of(*given[at(gear.follower)]->FirstChildElement()),
                   "this joint follows joint '" + machine.joints[at(gear.leader)].name +
                       "' by a fixed ratio",
                   "remove it; the other joint's position gives this one's");
  }
  if (!(gap < kOpen)) {
    const auto first =
        std::find_if(given.begin(), given.end(), [](auto* e) { return e != nullptr; });
    faults.error(first != given.end() ? **first : parent, scene::short_text(gap, 3) + " m",
                 "at these positions joint '" + machine.loops.front().name +
                     "' cannot close its loop: this gap is left",
                 "give positions that the links can reach, and only those of joints with motors");
    return;
  }
  for (std::size_t j = 0; j < q.size(); ++j) {
    Joint& joint = machine.joints[j];
    const bool moved = joint.initial != q[j];
    joint.initial = q[j];
    if (moved && joint.has_limits && (q[j] < joint.lower - 1e-6 || q[j] > joint.upper + 1e-6))
      faults.error(parent, scene::short_text(q[j], 6),
                   "joint '" + joint.name + "' would start beyond its limits, " +
                       scene::short_text(joint.lower, 6) + " to " +
                       scene::short_text(joint.upper, 6) + ", as its loop or ratio demands",
                   "correct its limits, or the position of the joint that moves it");
  }
}

}  // namespace navvy::scene_io
