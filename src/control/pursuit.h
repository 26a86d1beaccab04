// SPDX-License-Identifier: Apache-2.0
// Steering and speed on the way to a pose: pure pursuit of the line through it.
#pragma once

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::control {

/// Pose of a machine in the plane; the point is the middle of its rear axle.
struct PlanePose {
  /// Position [m] in W.
  Vec2 p = Vec2::Zero();
  /// Heading [rad], counter-clockwise from x.
  double yaw = 0;
};

/// A pose to drive to.
struct DriveGoal {
  /// Position [m] in W.
  Vec2 target = Vec2::Zero();
  /// False: arrive along the straight line from the start.
  bool has_heading = false;
  /// Heading at the target [rad].
  double heading = 0;
  /// Speed [m/s]; negative: backwards.
  double speed = 1.0;
};

/// The drive to one goal as a law from the machine's pose to steering and speed
/// [Coulter 1992, CMU-RI-TR-92-01].
///
/// The machine follows the line through the target along `heading`, so it arrives with that heading
/// when the distance is long enough. Backwards, the same law looks back along the line.
struct Pursuit {
  Vec2 target = Vec2::Zero();
  /// Heading at the target [rad].
  double heading = 0;
  /// Speed [m/s], negative backwards.
  double speed = 1;
  double wheelbase = 2.8;
  /// Largest bicycle steering angle [rad].
  double most_steer = 0.5;

  /// Returns the law for a goal seen from `start`. Without a heading it follows the straight line
  /// from start to target.
  static Pursuit of(const DriveGoal& goal, const scene::Drive& drive, const PlanePose& start);

  double sense() const { return speed < 0 ? -1 : 1; }
  /// Returns the remaining distance along the line [m]; negative beyond the target.
  double left(const PlanePose& at) const;
  /// Returns the bicycle steering angle [rad].
  double steer(const PlanePose& at) const;
  /// Returns the largest speed [m/s, >= 0] from which the machine still stops at the target.
  double speed_limit(const PlanePose& at) const;
  /// Predicts where a machine that rolls without slip ends when it starts at `start`, for the check
  /// before the run.
  PlanePose end_from(PlanePose start, double steer_rate) const;
};

/// Projects a pose of the base link onto the plane.
PlanePose plane_pose(const Pose& X_WB);

/// Acceleration and deceleration of the drive [m/s^2].
inline constexpr double kDriveAcceleration = 0.5;
/// Distance ahead of the target at which the brake is applied [m].
inline constexpr double kStopShort = 0.02;
/// Returns the largest speed [m/s, > 0] from which a machine still stops within `left` [m].
double stopping_speed(double left);

}  // namespace navvy::control
