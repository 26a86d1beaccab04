// SPDX-License-Identifier: Apache-2.0
// Odometry: the pose of a robot estimated from the registers of its encoders alone.
#pragma once

#include <cstdint>

#include "control/pursuit.h"
#include "scene/machine.h"

namespace navvy::control {

/// Returns the counts from `before` to `now` of a register of `bits` (2 to 32) that wraps, along
/// the shorter arc: -2^(bits-1) to 2^(bits-1) - 1. Correct as long as the wheel turned by less than
/// half of the register's range in between.
std::int64_t counts_between(std::uint64_t before, std::uint64_t now, int bits);

/// A wheel with its encoder, as odometry knows it.
struct CountedWheel {
  /// Counts per metre at the wheel's rim: counts per turn / (2 pi r).
  double counts_per_metre = 0;
  int bits = 16;
};

/// Dead reckoning of a differential drive [docs/machines.md, odometry]: between two readings of the
/// registers the robot has rolled an arc given by the mean and the difference of both sides. Slip,
/// missed counts and a rolling radius that differs from the nominal one go unnoticed, as on a real
/// robot.
class DifferentialOdometry {
 public:
  /// Takes the track width `track` [m] and both encoders.
  DifferentialOdometry(double track, const CountedWheel& left, const CountedWheel& right);
  /// Returns the odometry of the first driven wheel of each side, with the unloaded radii of the
  /// machine's file. @throws InputError for a machine without a differential drive, or without
  /// encoders on both sides.
  static DifferentialOdometry of(const scene::Machine& machine);

  /// Sets the present pose and the registers' present counts.
  void reset(const PlanePose& pose, std::uint64_t left, std::uint64_t right);
  /// Reads the registers again. Call it often enough that neither turns by half its range in
  /// between.
  void update(std::uint64_t left, std::uint64_t right);

  /// Pose of the point midway between the wheels.
  const PlanePose& pose() const { return pose_; }
  /// Distance along the path since the reset, negative backwards [m].
  double distance() const { return distance_; }

 private:
  double track_;
  CountedWheel left_, right_;
  std::uint64_t left_before_ = 0, right_before_ = 0;
  PlanePose pose_;
  double distance_ = 0;
};

}  // namespace navvy::control
