// SPDX-License-Identifier: Apache-2.0
// Poses of the bucket in a digging cycle. The operator and the check before a run share them.
#pragma once

#include "control/arm_kinematics.h"
#include "control/surface.h"

namespace navvy::control {

/// Angle of the line from the bucket's pin to its tip while the bucket carries soil, with its
/// opening upwards [rad]. Angles in this file are measured from the horizontal pointing outward;
/// positive angles point upwards.
inline constexpr double kCarry = -radians(178);
/// Angle of the line from pin to tip when the bucket is emptied [rad]: the opening points down and
/// towards the cab, with the floor plate nearly vertical.
inline constexpr double kOpen = -radians(55);
/// Angle of the cutting edge below the horizontal while the bucket is dragged through the soil
/// [rad].
inline constexpr double kAttack = radians(18);
/// Angle of the cutting edge while the bucket moves down into the soil [rad]. It is nearly
/// vertical, so that the wall at the far end of the trench stays upright.
inline constexpr double kPlunge = -radians(93);
/// Height of the tip above the ground before the bucket moves down [m].
inline constexpr double kClear = 0.3;

/// A point in the frame S of the swing axis, in cylindrical coordinates about that axis.
struct SwingPoint {
  /// Swing angle at which the arm points to the point [rad].
  double swing = 0;
  /// Distance of the point from the swing axis [m].
  double reach = 0;
  /// Height of the point above the origin of S, along the swing axis [m].
  double height = 0;
  /// Angle by which the xy plane of S rises outward towards the point, relative to the horizontal
  /// plane of W [rad].
  double pitch = 0;
  /// Converts an angle above the horizontal of W to an angle above the xy plane of S [rad].
  double level(double angle) const { return angle - pitch; }
};
/// Returns the point `p_W` (position in W [m]) in the swing axis frame S, whose pose in W is X_WS.
SwingPoint swing_point(const Pose& X_WS, const Vec3& p_W);

/// Computes the joint angles `q` at which a level bucket is ready to dump: when only the bucket
/// joint opens, the soil falls on `dump_at` (x, y in W [m]). X_WS is the pose of the swing axis
/// frame. The tip of the opened bucket is `clearance` [m] above the height `ground` [m]. If the arm
/// is too short for that, the clearance is reduced, but not below 0.3 m. `possible` receives the
/// clearance used. Returns false if even the smallest clearance is out of reach.
bool dump_pose(const ArmKinematics& arm, const Pose& X_WS, const Vec2& dump_at, double ground,
               double clearance, ArmAngles& q, double& possible);

/// Returns the height in W [m] of the highest ground around `p` (x, y in W [m]), within the foot of
/// a heap that is dumped there.
double heap_height(const SurfaceView& surface, const Vec2& p);

/// Smallest distance from the swing axis to a dig [m]: clear of wheels and undercarriage.
inline constexpr double kNearestDig = 3.0;
/// Distances from the swing axis between which the bucket's tip can dig [m]; both 0 if it cannot.
struct TipReach {
  double least = 0, most = 0;
};
/// Returns the distances at which the tip of `arm` can be at `height` [m] above the swing ring,
/// digging or plunging. `pitch` as SwingPoint::pitch. Found by trial in steps of 2 cm.
TipReach tip_reach(const ArmKinematics& arm, double height, double pitch);
/// Returns true if the tip can be at `reach` [m] and `height` [m] in S, digging or plunging.
/// `pitch` as SwingPoint::pitch.
bool can_dig_at(const ArmKinematics& arm, double reach, double height, double pitch);

/// Returns the angle of the line from pin to tip at which the cutting edge has the angle `cut`
/// [rad].
inline double with_cut(const ArmKinematics& arm, double cut) { return cut - arm.cut_angle(); }

}  // namespace navvy::control
