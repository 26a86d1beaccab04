// SPDX-License-Identifier: Apache-2.0
// What crosses the border between soil and whoever moves its tools: poses and twists in, impulses
// out. Axes of W, SI units.
#pragma once

#include "core/math.h"

namespace navvy::soil {

/// How a tool moves during the coming step. T is the link frame its shell is given in.
struct ToolMotion {
  int tool = -1;  ///< from add_tool
  Pose X_WT = Pose::Identity();
  Vec3 v_WT = Vec3::Zero();  ///< velocity of T's origin before soil acts [m/s]
  Vec3 w_WT = Vec3::Zero();  ///< angular velocity [rad/s]
  /// Inverse of the link's effective (articulated) mass at T's origin, order (angular, linear),
  /// axes of W: the change of (w, v) per unit of (angular impulse about T's origin, impulse). Zero:
  /// scripted, the tool does not yield.
  Mat6 inverse_mass = Mat6::Zero();
};

/// Where a tool is.
struct PlacedTool {
  int tool = -1;  ///< from add_tool
  Pose X_WT = Pose::Identity();
};

/// What soil did to a tool during one step.
struct ToolImpulse {
  Vec3 J_W = Vec3::Zero();  ///< impulse on the tool [N s]
  Vec3 L_W = Vec3::Zero();  ///< angular impulse about p_W [N m s]
  Vec3 p_W = Vec3::Zero();  ///< T's origin [m]
  /// Mean force and moment about T's origin [N, N m] over the last transfer that has ended: what is
  /// to be shown and read. The impulses of single steps have a saw-tooth of its period
  /// [docs/tools.md, force].
  Vec3 force_W = Vec3::Zero(), moment_W = Vec3::Zero();
  double normal = 0;    ///< sum of |normal impulses| [N s]
  double friction = 0;  ///< sum of |tangential impulses| [N s]
  // Momentum proof of the nodal solve, summed in double: J_W + sum of nodal momentum changes, and
  // its scale.
  Vec3 residual = Vec3::Zero(), residual_moment = Vec3::Zero();
  double scale = 0, scale_moment = 0;
};

/// Where a tool is, for waking ahead of it and for keeping soil near it awake.
struct ToolRegion {
  int tool = -1;  ///< from add_tool
  /// It stands on ground that bears it: keeps no soil awake.
  bool supported = false;
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< box of the shell in W [m]
  Vec3 velocity = Vec3::Zero();                 ///< of the box centre [m/s]
};

}  // namespace navvy::soil
