// SPDX-License-Identifier: Apache-2.0
// Pure-pursuit steering and speed control towards a target pose.
#pragma once

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::control {

/// Pose of a machine in the horizontal plane. The reference point is the middle of the rear axle.
struct PlanePose {
  /// Position (x, y) in W [m].
  Vec2 p = Vec2::Zero();
  /// Heading [rad], counter-clockwise from the x axis of W.
  double yaw = 0;
};

/// A target for a machine to drive to.
struct DriveGoal {
  /// Target position (x, y) in W [m].
  Vec2 target = Vec2::Zero();
  /// True if `heading` is prescribed; false if the machine arrives along the straight line from its
  /// start to the target.
  bool has_heading = false;
  /// Heading of the machine at the target [rad], counter-clockwise from the x axis of W.
  double heading = 0;
  /// Driving speed [m/s]; negative to drive backwards.
  double speed = 1.0;
};

/// Pure-pursuit control law [Coulter 1992, CMU-RI-TR-92-01]. It computes steering angle and speed
/// from the machine's current pose.
///
/// The machine follows the straight line through the target in the direction `heading`. If the
/// distance is long enough, it therefore arrives with that heading. When driving backwards, the
/// look-ahead point is behind the machine. Steering angles refer to the equivalent bicycle model
/// and are positive to the left [rad].
struct Pursuit {
  /// Target position (x, y) in W [m].
  Vec2 target = Vec2::Zero();
  /// Heading at the target [rad], counter-clockwise from the x axis of W.
  double heading = 0;
  /// Driving speed [m/s]; negative to drive backwards.
  double speed = 1;
  /// Wheelbase of the equivalent bicycle [m].
  double wheelbase = 2.8;
  /// Maximum steering angle of the equivalent bicycle [rad].
  double most_steer = 0.5;

  /// Returns the control law for `goal` and a machine with the drive `drive` that starts at
  /// `start`. Without a prescribed heading, the machine follows the straight line from start to
  /// target.
  static Pursuit of(const DriveGoal& goal, const scene::Drive& drive, const PlanePose& start);

  /// Returns the direction of travel: 1 forwards, -1 backwards.
  double sense() const { return speed < 0 ? -1 : 1; }
  /// Returns the remaining distance along the line [m]; negative if the machine is beyond the
  /// target.
  double left(const PlanePose& at) const;
  /// Returns the steering angle of the equivalent bicycle [rad] for a machine at `at`.
  double steer(const PlanePose& at) const;
  /// Returns the maximum speed [m/s, > 0] from which a machine at `at` can still stop at the
  /// target.
  double speed_limit(const PlanePose& at) const;
  /// Predicts the final pose of a machine that starts at `start` and rolls without slip.
  /// `steer_rate` is the maximum rate of the steering angle [rad/s]. The reachability check before
  /// a run uses it.
  PlanePose end_from(PlanePose start, double steer_rate) const;
};

/// Returns the pose of the base link projected onto the horizontal plane.
PlanePose plane_pose(const Pose& X_WB);

/// Acceleration and deceleration of a driving machine [m/s^2].
inline constexpr double kDriveAcceleration = 0.5;
/// Distance before the target at which the machine applies the brake [m].
inline constexpr double kStopShort = 0.02;
/// Returns the maximum speed [m/s, > 0] from which a machine can stop within the distance `left`
/// [m].
double stopping_speed(double left);

}  // namespace navvy::control
