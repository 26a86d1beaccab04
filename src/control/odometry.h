// SPDX-License-Identifier: Apache-2.0
// Where a robot thinks it is, from nothing but the registers of its encoders.
#pragma once

#include <cstdint>

#include "control/pursuit.h"
#include "scene/machine.h"

namespace navvy::control {

/// Counts from `before` to `now` of a register of `bits` (2 to 32) that wraps, the short way round:
/// right as long as the wheel turned by less than half of the register in between, -2^(bits-1) to
/// 2^(bits-1) - 1.
std::int64_t counts_between(std::uint64_t before, std::uint64_t now, int bits);

/// A wheel with its encoder, as odometry knows it.
struct CountedWheel {
  double counts_per_metre = 0;  ///< of the wheel's rim: counts a turn / (2 pi r)
  int bits = 16;
};

/// Dead reckoning of a differential drive [docs/machines.md, odometry]: between two looks at the
/// registers the robot has rolled an arc, by the mean and the difference of both sides. Slip,
/// missed counts and a radius that is not the tyre's under load go into it unseen, as on a real
/// robot.
class DifferentialOdometry {
 public:
  /// `track` [m] lies between the wheels.
  DifferentialOdometry(double track, const CountedWheel& left, const CountedWheel& right);
  /// Of the first driven wheel of each side; radii are the unloaded ones of the machine's file.
  /// @throws InputError for a machine without a differential drive, or without encoders on both
  /// sides.
  static DifferentialOdometry of(const scene::Machine& machine);

  /// The robot is at `pose` now, and its registers show these counts.
  void reset(const PlanePose& pose, std::uint64_t left, std::uint64_t right);
  /// A new look at the registers; often enough that neither turned by half its range.
  void update(std::uint64_t left, std::uint64_t right);

  /// Of the point midway between the wheels.
  const PlanePose& pose() const { return pose_; }
  /// Along the path, backwards negative, since the reset [m].
  double distance() const { return distance_; }

 private:
  double track_;
  CountedWheel left_, right_;
  std::uint64_t left_before_ = 0, right_before_ = 0;
  PlanePose pose_;
  double distance_ = 0;
};

}  // namespace navvy::control
