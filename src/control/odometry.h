// SPDX-License-Identifier: Apache-2.0
// Odometry: estimates the pose of a robot from the registers of its wheel encoders only.
#pragma once

#include <cstdint>
#include <optional>

#include "control/pursuit.h"
#include "scene/machine.h"

namespace navvy::control {

/// Returns the signed number of counts between two readings of an encoder register that has `bits`
/// bits (2 to 32) and wraps around. The result is in [-2^(bits-1), 2^(bits-1) - 1]. It is correct
/// if the wheel turned by less than half the register's range between the readings.
std::int64_t counts_between(std::uint64_t before, std::uint64_t now, int bits);

/// Encoder data of one wheel.
struct CountedWheel {
  /// Counts per metre rolled: counts per turn / (2 pi r), with the wheel's radius r [m].
  double counts_per_metre = 0;
  /// Number of bits of the encoder's register.
  int bits = 16;
};

/// Dead reckoning of a robot with a differential drive [docs/machines.md, odometry]. Between two
/// readings, the robot is assumed to roll along an arc; the mean of both sides gives its length and
/// their difference its angle. As on a real robot, the estimate does not account for slip, missed
/// counts, or a rolling radius that differs from the nominal one.
class DifferentialOdometry {
 public:
  /// Makes odometry for a track width `track` [m] (distance between left and right wheels) and one
  /// encoder per side. Call `reset` before the first `update`.
  DifferentialOdometry(double track, const CountedWheel& left, const CountedWheel& right);
  /// Returns the odometry of `machine`, from the first driven wheel with an encoder on each side.
  /// Wheel radii are the unloaded radii of the model file. @throws InputError if the machine has no
  /// differential drive, or no encoder on a driven wheel of one side.
  static DifferentialOdometry of(const scene::Machine& machine);

  /// Sets the current pose and the current register values, and sets the distance to 0.
  void reset(const PlanePose& pose, std::uint64_t left, std::uint64_t right);
  /// Updates the pose from the current register values. Call it often enough that no register
  /// advances by half its range between two calls.
  void update(std::uint64_t left, std::uint64_t right);

  /// Returns the estimated pose of the point midway between the left and right wheels.
  const PlanePose& pose() const { return pose_; }
  /// Returns the distance rolled since the last `reset` [m]; driving backwards decreases it.
  double distance() const { return distance_; }

 private:
  // Distance between the left and the right wheels [m].
  double track_;
  // Encoder data of the left and the right wheel.
  CountedWheel left_, right_;
  // Register values at the last reading.
  std::uint64_t left_before_ = 0, right_before_ = 0;
  // Estimated pose of the point midway between the left and right wheels.
  PlanePose pose_;
  // Distance rolled since the last `reset` [m]; driving backwards decreases it.
  double distance_ = 0;
};

/// Dead reckoning of a machine by two of its wheels: one pair on the left and right of one axle,
/// neither of them steered, each with an encoder.
struct WheelOdometry {
  /// Estimate of the pose of the point `p_M`, to be reset before the first update.
  DifferentialOdometry estimate;
  /// Indices in scene::Machine::joints of the joints of the left and the right wheel.
  int left = -1, right = -1;
  /// Point of the machine that moves along its heading, in the machine's frame M: the middle of the
  /// two wheels; with several driven axles or tracks, the middle of all driven wheels or rollers
  /// [m].
  Vec2 p_M = Vec2::Zero();
};
/// Returns the odometry of a machine, nothing if it lacks such wheels. The wheels of a differential
/// drive must be driven, and its track width is that of the drive; other machines have the distance
/// of the two wheels as track width.
std::optional<WheelOdometry> wheel_odometry(const scene::Machine& machine);

}  // namespace navvy::control
