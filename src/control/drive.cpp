// SPDX-License-Identifier: Apache-2.0
// Driving to a place: pure pursuit of the line through the target [Coulter 1992, CMU-RI-TR-92-01].
#include <algorithm>
#include <cmath>

#include "control/operator_state.h"
#include "core/log.h"

namespace navvy::control {
namespace {

constexpr double kAcceleration = 0.5;  // [m/s^2]
constexpr double kLookAhead = 3.0;     // about one wheelbase [m]
constexpr double kStandTime = 0.5;     // [s] at rest with the brake on

}  // namespace

bool Operator::State::run(const scene::DriveTo& step, const Observation& seen, double dt, Command& out) {
  const Vec2 p = seen.X_WB.translation().head<2>();
  const double yaw = std::atan2(seen.X_WB.linear()(1, 0), seen.X_WB.linear()(0, 0));
  const double sense = step.speed < 0 ? -1 : 1;
  if (m.begun == 0) {
    enter(Phase::kDrive);
    const Vec2 way = step.target - p;
    m.heading = step.has_heading ? step.heading : std::atan2(sense * way.y(), sense * way.x());
    m.speed = 0;
    m.standing = 0;
    m.begun = 1;
  }
  const Vec2 along(std::cos(m.heading), std::sin(m.heading)), across(-along.y(), along.x());
  const double left = sense * (step.target - p).dot(along), aside = (p - step.target).dot(across);
  const double limit = std::abs(step.speed) * 4 + 60 + (step.target - p).norm() / std::max(0.1, std::abs(step.speed));
  const bool late = m.phase_time > 3 * limit;
  if (left < 0.02 || m.standing > 0 || late) {
    out.drive = vehicle::DriveInput{0, 0, true};
    m.standing = seen.v_WB.head<2>().norm() < 0.02 ? m.standing + dt : std::max(m.standing, 1e-9);
    if (m.standing < kStandTime && m.phase_time < 4 * limit) return false;
    const double miss = (step.target - p).norm();
    if (miss > step.tolerance) log_warning("operator: drive_to ended " + std::to_string(miss) + " m from its target");
    return true;
  }
  const double possible = std::sqrt(2 * kAcceleration * std::max(0.0, left));
  m.speed = std::min({std::abs(step.speed), m.speed + kAcceleration * dt, std::max(0.05, possible)});
  // The point to aim at, seen from the machine.
  const double e = m.heading - yaw;
  const double x = kLookAhead * std::cos(e) * sense, y = sense * kLookAhead * std::sin(e) - aside * std::cos(e);
  const double curvature = 2 * y / (x * x + y * y);
  const double wheelbase = machine.drive.wheelbase;
  out.drive = vehicle::DriveInput{sense * m.speed, std::clamp(std::atan(wheelbase * curvature), -0.45, 0.45), false};
  return false;
}

}  // namespace navvy::control
