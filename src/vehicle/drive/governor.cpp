// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/governor.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr double kRamp = 1.5;          // [m/s2] travel pedal to speed (U)
constexpr double kSpeedTime = 0.3;     // [s] for wheels. tuned: BulletDrive.KeepsTheCommandedSpeed
constexpr double kIntegralTime = 1.0;  // [s] for wheels, and proportional for others. tuned: same

/// Returns the gain [N] per [m/s] of error. It suits the whole machine and is stable for wheels
/// that spin freely.
double gain_of(const DrivenWheels& wheels, double dt) {
  const double rim = wheels.spin_inertia / (wheels.radius * wheels.radius);
  return std::min(wheels.mass / wheels.response, 0.3 * rim / dt);
}

}  // namespace

// Power / speed limits the force, the tractive force limits it at low speed.
double SpeedGovernor::wheel_torque(const scene::Powertrain& powertrain, double speed,
                                   const DrivenWheels& wheels, double dt, double left) {
  if (wheels.count <= 0) return 0;
  const double force =
      ask(std::clamp(speed, -powertrain.max_speed, powertrain.max_speed), wheels, dt);
  const double now = wheels.spin * wheels.radius;
  // Full power from a crawl on; at rest the tractive force limits.
  const double crawl = std::max(std::abs(now), 0.1);
  const double most = std::min(powertrain.tractive_force, powertrain.power / crawl);
  const double driving = std::min(most, left / crawl);
  const double limited =
      give(force, now < 0 ? -driving : -most, now < 0 ? most : driving, wheels, dt);
  return limited * wheels.radius / wheels.count;
}

double SpeedGovernor::ask(double speed, const DrivenWheels& wheels, double dt) {
  const double before = asked_;
  asked_ = std::clamp(speed, asked_ - kRamp * dt, asked_ + kRamp * dt);
  const double error = asked_ - wheels.spin * wheels.radius;
  return wheels.mass * (asked_ - before) / dt + gain_of(wheels, dt) * error + integral_;
}

// Limits the force and then decides whether the integral may grow.
double SpeedGovernor::give(double force, double low, double high, const DrivenWheels& wheels,
                           double dt) {
  const double error = asked_ - wheels.spin * wheels.radius;
  const double limited = std::clamp(force, low, high);
  // Integrate only while the integral can act.
  if (force == limited || error * force < 0)
    integral_ =
        std::clamp(integral_ + gain_of(wheels, dt) /
                                   (wheels.response / kSpeedTime * kIntegralTime) * error * dt,
                   low, high);
  return limited;
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
