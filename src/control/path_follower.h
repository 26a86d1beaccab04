// SPDX-License-Identifier: Apache-2.0
// Steering and speed along a path. The commands depend only on the current pose of the machine.
#pragma once

#include "control/path.h"
#include "scene/drive.h"

namespace navvy::control {

/// Position and heading of a machine relative to its path.
struct PathPlace {
  /// Driven distance at the point of the path that is nearest to the machine [m].
  double s = 0;
  /// Lateral distance of the machine from the path [m], positive to the left of the path's heading.
  double aside = 0;
  /// Heading of the machine minus heading of the path [rad], in -pi..pi.
  double turned = 0;
};

/// Computes the steering angle and the speed limit of a machine that follows one leg of a path with
/// the middle of its rear axle, forwards or backwards
/// [Paden 2016, feedback of the rear wheel's position].
///
/// The path's curvature is fed forward as its mean over one metre, so that the wheels start to turn
/// before each bend. The speed limit slows the machine down enough for the wheels to follow.
/// Steering angles refer to the equivalent bicycle model and are positive to the left.
class PathFollower {
 public:
  /// Reads wheelbase, steering limits and steering rate from the drive.
  explicit PathFollower(const scene::Drive& drive);

  /// Returns the position of a machine at the pose `at` relative to `path`. The nearest point is
  /// searched on `leg`, starting from the driven distance `s` [m].
  PathPlace place(const Path& path, const PathLeg& leg, const PlanePose& at, double s) const;
  /// Returns the steering angle of the equivalent bicycle [rad] for a machine at `place`.
  double steer(const Path& path, const PathLeg& leg, const PathPlace& place) const;
  /// Returns the maximum speed [m/s, > 0] at the driven distance `s` [m]. At this speed the wheels
  /// can turn fast enough for the bends within the next 2 m, and the machine can stop at the end of
  /// the leg.
  double speed_limit(const Path& path, const PathLeg& leg, double s) const;
  /// Returns the steering angle of the equivalent bicycle [rad] to set while the machine stands at
  /// the start of the leg.
  double steer_at_start(const Path& path, const PathLeg& leg) const;

  /// Returns the maximum rate of the bicycle's steering angle [rad/s].
  double steer_rate() const { return bicycle_.steer_rate; }
  /// Returns the minimum turning radius [m].
  double least_radius() const { return least_radius_; }

 private:
  // Drive with the geometry of the equivalent bicycle.
  scene::AckermannDrive bicycle_;
  // Maximum steering angle of the bicycle [rad], and the turning radius at that angle [m].
  double most_steer_ = 0, least_radius_ = 0;
};

/// Ratio of the smallest radius in a planned path to the machine's minimum turning radius [-]. It
/// is greater than 1, so that steering corrections remain possible in the tightest bend.
inline constexpr double kRadiusReserve = 1.2;

}  // namespace navvy::control
