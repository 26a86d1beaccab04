// SPDX-License-Identifier: Apache-2.0
// Interface between soil and whatever moves its tools: poses and twists in, impulses out. Axes of
// W, SI units.
#pragma once

#include "core/math.h"

namespace navvy::soil {

/// Motion of a tool during the coming step. T is the link frame of its shell.
struct ToolMotion {
  /// Index from add_tool.
  int tool = -1;
  Pose X_WT = Pose::Identity();
  /// Velocity of T's origin before soil acts [m/s].
  Vec3 v_WT = Vec3::Zero();
  /// Angular velocity [rad/s].
  Vec3 w_WT = Vec3::Zero();
  /// Inverse of the link's effective (articulated) mass at T's origin, order (angular, linear),
  /// axes of W: the change of (w, v) per unit of (angular impulse about T's origin, impulse). Zero:
  /// scripted, the tool does not yield.
  Mat6 inverse_mass = Mat6::Zero();
};

/// Pose of a tool.
struct PlacedTool {
  /// Index from add_tool.
  int tool = -1;
  Pose X_WT = Pose::Identity();
};

/// Impulse of the soil on a tool during one step.
struct ToolImpulse {
  /// Impulse on the tool [N s].
  Vec3 J_W = Vec3::Zero();
  /// Angular impulse about p_W [N m s].
  Vec3 L_W = Vec3::Zero();
  /// Origin of T [m].
  Vec3 p_W = Vec3::Zero();
  /// Mean force and moment about T's origin [N, N m] over the last completed transfer, for display
  /// and sensors. The impulses of single steps show a saw-tooth of that period
  /// [docs/tools.md, force].
  Vec3 force_W = Vec3::Zero(), moment_W = Vec3::Zero();
  /// Sum of |normal impulses| [N s].
  double normal = 0;
  /// Sum of |tangential impulses| [N s].
  double friction = 0;
  // Momentum check of the nodal solve, summed in double: J_W + sum of nodal momentum changes, and
  // its scale.
  Vec3 residual = Vec3::Zero(), residual_moment = Vec3::Zero();
  double scale = 0, scale_moment = 0;
};

/// Region of a tool: soil ahead of it becomes active, and soil near it stays active.
struct ToolRegion {
  /// Index from add_tool.
  int tool = -1;
  /// The ground supports it: it keeps no soil active.
  bool supported = false;
  /// Box of the shell in W [m].
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
  /// Velocity of the box centre [m/s].
  Vec3 velocity = Vec3::Zero();
};

}  // namespace navvy::soil
