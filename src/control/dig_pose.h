// SPDX-License-Identifier: Apache-2.0
// Poses of the bucket in a digging cycle, for the operator and for the check before the run.
#pragma once

#include "control/arm_kinematics.h"

namespace navvy::control {

// Angles of the line pin to tip, or of the cutting edge where said; above the horizontal, outward.
inline constexpr double kCarry = -radians(178);  ///< mouth up
/// emptied: floor plate near vertical, mouth down and towards the cab.
inline constexpr double kOpen = -radians(55);
/// Cutting edge below the horizontal at the end of its turn in.
inline constexpr double kAttack = radians(18);
/// Cutting edge on the way down: walls at the far end stay upright.
inline constexpr double kPlunge = -radians(93);
inline constexpr double kClear = 0.3;  ///< tip over the ground before it goes down [m]

/// A point of W in the frame S of the swing axis.
struct SwingPoint {
  double swing = 0;   ///< [rad]
  double reach = 0;   ///< from the axis [m]
  double height = 0;  ///< above S's origin [m]
  double pitch = 0;   ///< slope of S's plane in that direction, up outward [rad]
  /// Angle over W's horizontal as one in S.
  double level(double angle) const { return angle - pitch; }
};
SwingPoint swing_point(const Pose& X_WS, const Vec3& p_W);

/// Joint angles that hold a level bucket so that, opened, it drops its soil at `dump_at` with the
/// tip `clearance` over `ground`; where the arm is too short for that the clearance is taken down
/// to 0.3 m. False when even that is out of reach. `possible` receives the clearance.
bool dump_pose(const ArmKinematics& arm, const Pose& X_WS, const Vec2& dump_at, double ground,
               double clearance, ArmAngles& q, double& possible);

/// Angle of the line pin to tip that gives the cutting edge this angle.
inline double with_cut(const ArmKinematics& arm, double cut) { return cut - arm.cut_angle(); }

}  // namespace navvy::control
