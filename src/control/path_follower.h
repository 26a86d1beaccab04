// SPDX-License-Identifier: Apache-2.0
// Steering and speed along a path: a memoryless law of the machine's pose.
#pragma once

#include "control/path.h"
#include "scene/drive.h"

namespace navvy::control {

/// Position of a machine relative to its path.
struct PathPlace {
  /// Nearest point on the path [m].
  double s = 0;
  /// Distance from the path, positive to its left [m].
  double aside = 0;
  /// Heading relative to the path's [rad].
  double turned = 0;
};

/// Follows one leg of a path with the middle of the rear axle, forwards and backwards alike
/// [Paden 2016, feedback of the rear wheel's position]. The path's own curvature is fed forward as
/// its mean over a metre, so that the wheels turn ahead of each bend; the machine slows down until
/// they can.
class PathFollower {
 public:
  /// Takes wheelbase, steering limits and rates from the drive.
  explicit PathFollower(const scene::Drive& drive);

  /// Returns the position relative to the path of a machine at `at`, searched near s on this leg.
  PathPlace place(const Path& path, const PathLeg& leg, const PlanePose& at, double s) const;
  /// Returns the steering angle of the bicycle model [rad].
  double steer(const Path& path, const PathLeg& leg, const PathPlace& place) const;
  /// Returns the largest speed [m/s, > 0] at which the wheels are turned in time for this bend and
  /// those ahead, and at which the machine still stops at the leg's end.
  double speed_limit(const Path& path, const PathLeg& leg, double s) const;
  /// Returns the bicycle steering angle to set before the leg begins [rad].
  double steer_at_start(const Path& path, const PathLeg& leg) const;

  /// Largest rate of the bicycle steering angle [rad/s].
  double steer_rate() const { return bicycle_.steer_rate; }
  /// Radius of the tightest turn [m].
  double least_radius() const { return least_radius_; }

 private:
  scene::AckermannDrive bicycle_;
  double most_steer_ = 0, least_radius_ = 0;
};

/// Ratio of a path's smallest radius to the machine's, so that steering can still correct.
inline constexpr double kRadiusReserve = 1.2;

}  // namespace navvy::control
