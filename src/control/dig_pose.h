// SPDX-License-Identifier: Apache-2.0
// Poses of the bucket in a digging cycle, for the operator and for the check before the run.
#pragma once

#include "control/arm_kinematics.h"

namespace navvy::control {

// Angles of the line from pin to tip, or of the cutting edge where stated, above the horizontal and
// positive outward [rad].
// Carrying: mouth up.
inline constexpr double kCarry = -radians(178);
/// Emptied: floor plate near vertical, mouth down and towards the cab.
inline constexpr double kOpen = -radians(55);
/// Cutting edge below the horizontal at the end of its rotation into the soil.
inline constexpr double kAttack = radians(18);
/// Cutting edge on the way down, so that walls at the far end stay upright.
inline constexpr double kPlunge = -radians(93);
/// Height of the tip over the ground before it goes down [m].
inline constexpr double kClear = 0.3;

/// A point of W in the frame S of the swing axis.
struct SwingPoint {
  /// Swing angle of the point [rad].
  double swing = 0;
  /// Distance from the swing axis [m].
  double reach = 0;
  /// Height above S's origin [m].
  double height = 0;
  /// Slope of S's plane in that direction, positive when it rises outward [rad].
  double pitch = 0;
  /// Converts an angle over W's horizontal to one in S [rad].
  double level(double angle) const { return angle - pitch; }
};
/// Returns a point of W [m] in the frame S of the swing axis.
SwingPoint swing_point(const Pose& X_WS, const Vec3& p_W);

/// Computes the joint angles that hold a level bucket so that, once opened, it drops its soil at
/// `dump_at` with the tip `clearance` [m] over `ground`. Where the arm is too short, the clearance
/// is reduced to 0.3 m at least; `possible` receives it. Returns false when even that is out of
/// reach.
bool dump_pose(const ArmKinematics& arm, const Pose& X_WS, const Vec2& dump_at, double ground,
               double clearance, ArmAngles& q, double& possible);

/// Returns the angle of the line from pin to tip that gives the cutting edge the angle `cut` [rad].
inline double with_cut(const ArmKinematics& arm, double cut) { return cut - arm.cut_angle(); }

}  // namespace navvy::control
