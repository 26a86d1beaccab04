// SPDX-License-Identifier: Apache-2.0
// Steering and speed along a path: a law from the machine's pose, without memory.
#pragma once

#include "control/path.h"
#include "scene/drive.h"

namespace navvy::control {

/// Where a machine is beside its path.
struct PathPlace {
  double s = 0;       ///< nearest place on the path [m]
  double aside = 0;   ///< distance from it, positive to the path's left [m]
  double turned = 0;  ///< heading against the path's [rad]
};

/// Follows one leg of a path with the middle of the rear axle, forwards or backwards alike
/// [Paden 2016, feedback of the rear wheel's position]. The path's own curvature is fed forward as
/// its mean over a metre, so that the wheels turn ahead of each bend; the machine slows down until
/// they can.
class PathFollower {
 public:
  explicit PathFollower(const scene::Drive& drive);

  /// The machine at `at`, near the place s on this leg.
  PathPlace place(const Path& path, const PathLeg& leg, const PlanePose& at, double s) const;
  /// Bicycle angle [rad].
  double steer(const Path& path, const PathLeg& leg, const PathPlace& place) const;
  /// Largest speed [m/s, > 0] at which the wheels are turned in time for this bend and those ahead,
  /// and at which the machine still stops at the leg's end.
  double speed_limit(const Path& path, const PathLeg& leg, double s) const;
  /// Bicycle angle to stand with before the leg begins [rad].
  double steer_at_start(const Path& path, const PathLeg& leg) const;

  double steer_rate() const { return bicycle_.steer_rate; }  ///< [rad/s]
  double least_radius() const { return least_radius_; }      ///< of the tightest turn [m]

 private:
  scene::AckermannDrive bicycle_;
  double most_steer_ = 0, least_radius_ = 0;
};

/// A path's bends are wider than the machine's tightest by this, so that steering can still
/// correct.
inline constexpr double kRadiusReserve = 1.2;

}  // namespace navvy::control
