// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/ackermann.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {

double max_bicycle_angle(const scene::AckermannDrive& drive) {
  // A wheel across the machine would be an infinite tangent.
  const double inner = std::tan(std::min(drive.max_steer, radians(89)));
  return inner > 0 ? std::atan(drive.wheelbase / (drive.wheelbase / inner + 0.5 * drive.track)) : 0;
}

SteerAngles ackermann(const scene::AckermannDrive& drive, double bicycle) {
  const double most = max_bicycle_angle(drive);
  const double t = std::tan(std::clamp(bicycle, -most, most));
  // L / (R -+ W/2) with R = L / t, without dividing by a t of zero.
  const double share = 0.5 * drive.track * t / drive.wheelbase;
  return {std::atan2(t, 1 - share), std::atan2(t, 1 + share)};
}

AckermannLine::AckermannLine(const scene::AckermannDrive& drive, const std::vector<DriveWheel>& wheels)
    : DriveLine(drive, {all_driven(wheels)}), drive_(drive) {}

Roll AckermannLine::roll(const DriveInput& input) const {
  const double speed = input.brake ? 0 : std::clamp(input.speed, -drive_.max_speed, drive_.max_speed);
  const double most = max_bicycle_angle(drive_);
  return {speed, speed * std::tan(std::clamp(input.steer, -most, most)) / drive_.wheelbase};
}

double AckermannLine::rolling_spin(const Roll& roll, const DriveWheel& wheel) const {
  // The differential's cage: in a turn the outer wheel is faster by what the inner one is slower, which nobody asks of
  // an engine without forces.
  return roll.speed / wheel.radius;
}

std::optional<double> AckermannLine::steer_angle(const DriveInput& input, const DriveWheel& wheel) const {
  // Under the brake too: a standing machine turns its wheels for the next start.
  const SteerAngles steer = ackermann(drive_, input.steer);
  return wheel.left ? steer.left : steer.right;
}

double AckermannLine::group_speed(const DriveInput& input, std::size_t group) const {
  (void)group;  // all driven wheels are one; the governor knows the largest speed
  return input.speed;
}

scene::AckermannDrive bicycle_of(const scene::AckermannDrive& drive) { return drive; }

double command_of(const scene::AckermannDrive& drive, double bicycle, double speed) {
  (void)drive, (void)speed;
  return bicycle;
}

}  // namespace navvy::vehicle
