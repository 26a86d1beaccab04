// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/governor.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr double kRamp = 1.5;          // [m/s2] travel pedal to speed (U)
constexpr double kSpeedTime = 0.3;     // [s] tuned: BulletDrive.KeepsTheAskedSpeed
constexpr double kIntegralTime = 1.0;  // [s] tuned: same

}  // namespace

double SpeedGovernor::wheel_torque(const scene::Powertrain& powertrain, double speed, const DrivenWheels& wheels,
                                   double dt) {
  if (wheels.count <= 0) return 0;
  const double goal = std::clamp(speed, -powertrain.max_speed, powertrain.max_speed);
  const double before = asked_;
  asked_ = std::clamp(goal, asked_ - kRamp * dt, asked_ + kRamp * dt);
  const double now = wheels.spin * wheels.radius;
  // Full power from a crawl on; at rest the tractive force rules.
  const double power_limit = powertrain.power / std::max(std::abs(now), 0.1);
  const double most = std::min(powertrain.tractive_force, power_limit);
  // The gain suits the whole machine but stays stable for wheels that spin freely.
  const double rim = wheels.spin_inertia / (wheels.radius * wheels.radius);
  const double gain = std::min(wheels.mass / kSpeedTime, 0.3 * rim / dt);
  const double error = asked_ - now;
  const double force = wheels.mass * (asked_ - before) / dt + gain * error + integral_;
  const double limited = std::clamp(force, -most, most);
  // Integrates only while it can act.
  if (force == limited || error * force < 0)
    integral_ = std::clamp(integral_ + gain / kIntegralTime * error * dt, -most, most);
  return limited * wheels.radius / wheels.count;
}

void SpeedGovernor::reset(double speed) {
  asked_ = speed;
  integral_ = 0;
}

void SpeedGovernor::visit(Archive& a) {
  a("asked", asked_);
  a("integral", integral_);
}

}  // namespace navvy::vehicle
