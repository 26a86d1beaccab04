// SPDX-License-Identifier: Apache-2.0
// Steering and speed on the way to a pose: pure pursuit of the line through it.
#pragma once

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::control {

/// Where a machine stands and faces; the point is the middle of its rear axle.
struct PlanePose {
  Vec2 p = Vec2::Zero();  ///< [m] in W
  double yaw = 0;         ///< [rad]
};

/// A pose to drive to.
struct DriveGoal {
  Vec2 target = Vec2::Zero();  ///< [m] in W
  bool has_heading = false;    ///< false: along the straight line from the start
  double heading = 0;          ///< [rad]
  double speed = 1.0;          ///< [m/s]; negative: backwards
};

/// The drive to one goal as a law from the machine's pose to steering and speed
/// [Coulter 1992, CMU-RI-TR-92-01].
///
/// The machine follows the line through the target along `heading`, so it arrives facing that way
/// when the way is long enough. Backwards the same law looks back along the line.
struct Pursuit {
  Vec2 target = Vec2::Zero();
  double heading = 0;  ///< at the target [rad]
  double speed = 1;    ///< [m/s], negative backwards
  double wheelbase = 2.8;
  double most_steer = 0.5;  ///< bicycle angle [rad]

  /// The goal as seen from `start`; without a heading the straight line from start to target is
  /// followed.
  static Pursuit of(const DriveGoal& goal, const scene::Drive& drive, const PlanePose& start);

  double sense() const { return speed < 0 ? -1 : 1; }
  /// Way to go along the line [m]; negative beyond the target.
  double left(const PlanePose& at) const;
  /// Bicycle angle [rad].
  double steer(const PlanePose& at) const;
  /// Largest speed [m/s, >= 0] from which the machine still stops at the target.
  double speed_limit(const PlanePose& at) const;
  /// Where a machine that rolls without slip ends from `start`: what to expect before the run.
  PlanePose end_from(PlanePose start, double steer_rate) const;
};

PlanePose plane_pose(const Pose& X_WB);

inline constexpr double kDriveAcceleration = 0.5;  ///< [m/s^2]
/// The brake goes on this far ahead of the target [m].
inline constexpr double kStopShort = 0.02;
/// Largest speed [m/s, > 0] from which a machine still stops after `left` [m].
double stopping_speed(double left);

}  // namespace navvy::control
