// SPDX-License-Identifier: Apache-2.0
#include "formats/ros/machine_frames.h"

#include "core/error.h"

namespace navvy::formats::ros {
namespace {

constexpr const char* kBase = "base_link";

const scene::Link& link_at(const scene::Machine& machine, int link) {
  return machine.links.at(static_cast<std::size_t>(link));
}

/// Returns the axis of a joint in the frame of its child link, with all joints at position zero.
Vec3 axis_in_child(const scene::Joint& joint) { return joint.X_LcJ.linear() * joint.axis; }

/// Returns true if the axis of a revolute joint misses the origin of the child's frame. Below a
/// nanometre it is rounding.
bool axis_misses_child(const scene::Joint& joint) {
  if (joint.type != scene::Joint::Type::kRevolute) return false;
  return joint.X_LcJ.translation().cross(axis_in_child(joint)).norm() > 1e-9;
}

}  // namespace

std::string name_beside_links(const scene::Machine& machine, std::string name) {
  while (machine.link_index(name) >= 0) name += "_";
  return name;
}

std::vector<MachineFrame> machine_frames(const scene::Machine& machine) {
  std::vector<MachineFrame> out;
  const scene::Link& base = link_at(machine, 0);
  if (base.name != kBase)
    out.push_back({name_beside_links(machine, kBase), -1, 0, base.X_ML.inverse(), -1});
  out.push_back({base.name, static_cast<int>(out.size()) - 1, 0, Pose::Identity(), -1});
  // Joints are in tree order, so a parent's frame is in the list before it is needed.
  for (std::size_t i = 0; i < machine.joints.size(); ++i) {
    const scene::Joint& joint = machine.joints[i];
    const int parent = frame_of_link(out, machine, joint.parent);
    const std::string& name = link_at(machine, joint.child).name;
    if (!axis_misses_child(joint)) {
      out.push_back({name, parent, joint.child, Pose::Identity(), static_cast<int>(i)});
      continue;
    }
    Pose X_LF = Pose::Identity();
    X_LF.translation() = joint.X_LcJ.translation();
    out.push_back({name_beside_links(machine, joint.name + "_axis"), parent, joint.child, X_LF,
                   static_cast<int>(i)});
    out.push_back({name, static_cast<int>(out.size()) - 1, joint.child, Pose::Identity(), -1});
  }
  return out;
}

int frame_of_link(const std::vector<MachineFrame>& frames, const scene::Machine& machine,
                  int link) {
  const std::string& name = link_at(machine, link).name;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i].link == link && frames[i].name == name) return static_cast<int>(i);
  throw Error("machine '" + machine.name + "': no frame of the link '" + name + "'");
}

bool moves(const scene::Machine& machine, const MachineFrame& frame) {
  return frame.joint >= 0 && machine.joints.at(static_cast<std::size_t>(frame.joint)).type !=
                                 scene::Joint::Type::kFixed;
}

Pose pose_in_parent(const scene::Machine& machine, const std::vector<MachineFrame>& frames,
                    const MachineFrame& frame) {
  const auto pose = [&](const MachineFrame& f) { return link_at(machine, f.link).X_ML * f.X_LF; };
  if (frame.parent < 0) return pose(frame);
  const MachineFrame& parent = frames.at(static_cast<std::size_t>(frame.parent));
  // On one link the poses of links cancel, which keeps rounding out of fixed frames.
  if (parent.link == frame.link) return parent.X_LF.inverse() * frame.X_LF;
  return pose(parent).inverse() * pose(frame);
}

}  // namespace navvy::formats::ros
