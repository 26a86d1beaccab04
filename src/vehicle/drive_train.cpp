// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive_train.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr double kRamp = 1.5;          // [m/s2] travel pedal to speed (U)
constexpr double kSpeedTime = 0.3;     // [s] tuned: BulletDrive.KeepsTheAskedSpeed
constexpr double kIntegralTime = 1.0;  // [s] tuned: same

}  // namespace

double max_bicycle_angle(const scene::Drive& drive) {
  const double inner = std::tan(std::min(drive.max_steer, radians(89)));
  return inner > 0 ? std::atan(drive.wheelbase / (drive.wheelbase / inner + 0.5 * drive.track)) : 0;
}

SteerAngles ackermann(const scene::Drive& drive, double bicycle) {
  const double most = max_bicycle_angle(drive);
  const double t = std::tan(std::clamp(bicycle, -most, most));
  // L / (R -+ W/2) with R = L / t, without dividing by a t of zero.
  const double share = 0.5 * drive.track * t / drive.wheelbase;
  return {std::atan2(t, 1 - share), std::atan2(t, 1 + share)};
}

double DriveTrain::wheel_torque(const scene::Drive& drive, double speed, double cage, double radius, int wheels,
                                double mass, double spin_inertia, double dt) {
  if (wheels <= 0) return 0;
  const double goal = std::clamp(speed, -drive.max_speed, drive.max_speed);
  const double before = asked_;
  asked_ = std::clamp(goal, asked_ - kRamp * dt, asked_ + kRamp * dt);
  const double now = cage * radius;
  const double power_limit = drive.power / std::max(std::abs(now), 0.1);
  const double most = std::min(drive.tractive_force, power_limit);
  // The gain suits the whole machine but stays stable for wheels that spin freely.
  const double rim = spin_inertia / (radius * radius);
  const double gain = std::min(mass / kSpeedTime, 0.3 * rim / dt);
  const double error = asked_ - now;
  const double force = mass * (asked_ - before) / dt + gain * error + integral_;
  const double limited = std::clamp(force, -most, most);
  // Integrates only while it can act.
  if (force == limited || error * force < 0)
    integral_ = std::clamp(integral_ + gain / kIntegralTime * error * dt, -most, most);
  return limited * radius / wheels;
}

void DriveTrain::reset(double cage_speed) {
  asked_ = cage_speed;
  integral_ = 0;
}

void DriveTrain::hash(StateHash& hash) const {
  hash.value(asked_);
  hash.value(integral_);
}

void DriveTrain::save(StateWriter& writer) const {
  writer.value(asked_);
  writer.value(integral_);
}

void DriveTrain::load(StateReader& reader) {
  asked_ = reader.value<double>();
  integral_ = reader.value<double>();
}

}  // namespace navvy::vehicle
