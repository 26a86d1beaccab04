// SPDX-License-Identifier: Apache-2.0
// The drive_to step: speed ramp, pursuit, brake.
#include <algorithm>
#include <cmath>

#include "control/operator_state.h"
#include "control/pursuit.h"
#include "core/log.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::control {
namespace {

constexpr double kStandTime = 0.5;    // [s] at rest with the brake on
constexpr double kStandSpeed = 0.02;  // [m/s]

}  // namespace

bool Operator::State::run(const scene::DriveTo& step, const Observation& seen, double dt, Command& out) {
  const PlanePose at = plane_pose(seen.X_WB);
  Pursuit pursuit = Pursuit::of(step, machine.drive, at);
  if (m.begun == 0) {
    enter(Phase::kDrive);
    m.heading = pursuit.heading;
    m.speed = 0;
    m.standing = 0;
    m.way = (step.target - at.p).norm();
    m.begun = 1;
  }
  pursuit.heading = m.heading;
  const double limit = 30 + 3 * m.way / std::max(0.05, std::abs(step.speed));
  const bool late = m.phase_time > limit;
  if (pursuit.left(at) < kStopShort || m.standing > 0 || late) {
    // Brake, and stand for a moment before the next step; `standing` stays positive once it began.
    out.drive = vehicle::DriveInput{0, 0, true};
    m.standing = seen.v_WB.head<2>().norm() < kStandSpeed ? m.standing + dt : std::max(m.standing, 1e-9);
    if (m.standing < kStandTime && m.phase_time < limit + 10) return false;
    const double miss = (step.target - at.p).norm();
    if (late) log_warning("operator: drive_to gave up after " + std::to_string(m.phase_time) + " s");
    if (miss > step.tolerance) log_warning("operator: drive_to ended " + std::to_string(miss) + " m from its target");
    return true;
  }
  m.speed = std::min({std::abs(step.speed), m.speed + kDriveAcceleration * dt, pursuit.speed_limit(at)});
  const double speed = pursuit.sense() * m.speed;
  out.drive = vehicle::DriveInput{speed, vehicle::steer_command(machine.drive, pursuit.steer(at), speed), false};
  return false;
}

}  // namespace navvy::control
