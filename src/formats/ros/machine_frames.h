// SPDX-License-Identifier: Apache-2.0
// The tree of a machine's coordinate frames, as URDF and tf have it.
#pragma once

#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::formats::ros {

/// A frame F that is rigidly attached to a link of a machine.
struct MachineFrame {
  /// Name of the frame, unique within the machine.
  std::string name;
  /// Index of the parent frame, which comes earlier in the list; -1 for the root.
  int parent = -1;
  /// Index in Machine::links of the link that carries the frame.
  int link = 0;
  /// Pose of the frame in the frame L of that link.
  Pose X_LF = Pose::Identity();
  /// Index in Machine::joints of the joint between the parent and this frame; -1 if both frames are
  /// on the same link.
  int joint = -1;
};

/// Returns the frames of a machine, parents before their children.
///
/// The root is the machine's frame M and is called "base_link" [REP 105]; below it, each link has a
/// frame of its own with the link's name. If the base link itself is called "base_link", its frame
/// is the root and M has none. URDF requires that the axis of a revolute joint passes through the
/// origin of the child's frame. Where it does not, a frame "<joint>_axis" with the axes of the
/// child link is between parent and child: the joint moves that frame, to which the child's frame
/// is fixed. A name that a link has already gets underscores at its end.
std::vector<MachineFrame> machine_frames(const scene::Machine& machine);

/// Returns the index in `frames` of the frame of the link with index `link`.
int frame_of_link(const std::vector<MachineFrame>& frames, const scene::Machine& machine, int link);

/// Returns true if the frame moves relative to its parent.
bool moves(const scene::Machine& machine, const MachineFrame& frame);

/// Returns the pose of the frame `frame` in its parent frame with all joints at position zero; the
/// pose in the machine's frame M for the root.
Pose pose_in_parent(const scene::Machine& machine, const std::vector<MachineFrame>& frames,
                    const MachineFrame& frame);

/// Returns `name`, followed by as many underscores as it takes that no link of `machine` is called
/// so.
std::string name_beside_links(const scene::Machine& machine, std::string name);

}  // namespace navvy::formats::ros
