// SPDX-License-Identifier: Apache-2.0
// Parts of a machine that couple its joints beyond the tree of its links: fixed ratios between two
// joints, and joints that close loops; and points of links on which outside components pull.
#pragma once

#include <string>

#include "core/math.h"
#include "scene/fields.h"

namespace navvy::scene {

/// A fixed ratio between the positions of two joints of one machine:
/// position of the follower = `ratio` x position of the leader + `offset`. It comes from <mimic> of
/// SDF or URDF, or from a joint of SDF's type gearbox. Nothing else drives the follower.
struct JointGear {
  std::string name;   ///< name of the joint in whose element the ratio is given
  int follower = -1;  ///< index in Machine::joints of the joint that follows
  int leader = -1;    ///< index in Machine::joints of the joint that it follows
  double ratio = 1;   ///< change of the follower's position per change of the leader's
  double offset = 0;  ///< position of the follower where the leader is at zero [rad] or [m]

  /// Passes the fields to the visitor `f`; they follow from SDF elements.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the joint.");
    f.derived("follower", follower);
    f.derived("leader", leader);
    f.derived("ratio", ratio);
    f.derived("offset", offset);
  }
};

/// A joint between two links that are part of the tree already, so that it closes a loop. It has no
/// position, motor or limits of its own: it only keeps its two halves together.
struct LoopJoint {
  /// Type of the relative motion, with the values of Joint::Type.
  enum class Type { kFixed, kRevolute, kPrismatic, kBall };
  std::string name;               ///< name of the joint
  Type type = Type::kFixed;       ///< type of the joint
  int parent = -1;                ///< index of the parent link in Machine::links
  int child = -1;                 ///< index of the child link in Machine::links
  Pose X_LpJ = Pose::Identity();  ///< pose of the joint's parent half in the parent link's frame
  Pose X_LcJ = Pose::Identity();  ///< pose of the joint's child half in the child link's frame
  Vec3 axis = Vec3::UnitZ();      ///< unit vector of the axis, in the frames of both halves

  /// Passes the fields to the visitor `f`; they follow from the <joint> of the file.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the joint.");
    f.derived_kind("type", type);
    f.derived("parent", parent);
    f.derived("child", child);
    f.derived("parent_pose", X_LpJ);
    f.derived("child_pose", X_LcJ);
    f.derived("axis", axis);
  }
};

/// A point of a link on which components outside the simulation pull: wind, a rope, a hoist.
struct ForceInput {
  bool has_point = false;   ///< false: the force acts at the centre of mass
  Vec3 p_L = Vec3::Zero();  ///< point on which the force acts, in the link's frame [m]

  /// Passes the fields of a <navvy:force_input> to the visitor `f`.
  void describe(Fields& f) {
    f("point_m", p_L, {-1e3, 1e3},
      "Point on which the force acts, in the link's frame; without it, the centre of mass.",
      given(has_point));
  }
};

}  // namespace navvy::scene
