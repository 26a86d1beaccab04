// SPDX-License-Identifier: Apache-2.0
#include "control/pursuit.h"

#include <algorithm>
#include <cmath>

#include "vehicle/drive/drive_line.h"

namespace navvy::control {
namespace {

// A long look-ahead is calm far away, a short one ends close to the line; below half a wheelbase
// the steering, which takes a second from lock to lock, would oscillate about the line. [m] for a
// wheelbase of kTunedWheelbase [m], in proportion for others. tuned: Drive.ArrivesBesideAndTurned
constexpr double kLongLook = 3.0, kShortLook = 1.5, kTunedWheelbase = 2.8;
constexpr double kCreep = 0.05;  // [m/s]

}  // namespace

PlanePose plane_pose(const Pose& X_WB) {
  return {X_WB.translation().head<2>(), std::atan2(X_WB.linear()(1, 0), X_WB.linear()(0, 0))};
}

Pursuit Pursuit::of(const DriveGoal& goal, const scene::Drive& drive, const PlanePose& start) {
  Pursuit pursuit;
  pursuit.target = goal.target;
  pursuit.speed = goal.speed;
  const scene::AckermannDrive bicycle = vehicle::equivalent_bicycle(drive);
  pursuit.wheelbase = bicycle.wheelbase;
  const Vec2 displacement = pursuit.sense() * (goal.target - start.p);
  pursuit.heading = goal.has_heading             ? goal.heading
                    : displacement.norm() < 0.05 ? start.yaw
                                                 : std::atan2(displacement.y(), displacement.x());
  // max_steer is the inner wheel's: the circle's centre is half a track width nearer to it than to
  // the bicycle.
  pursuit.most_steer = std::atan(
      bicycle.wheelbase / (bicycle.wheelbase / std::tan(bicycle.max_steer) + 0.5 * bicycle.track));
  return pursuit;
}

double Pursuit::left(const PlanePose& at) const {
  return sense() * (target - at.p).dot(Vec2(std::cos(heading), std::sin(heading)));
}

double Pursuit::steer(const PlanePose& at) const {
  const Vec2 across(-std::sin(heading), std::cos(heading));
  const double aside = (at.p - target).dot(across), e = heading - at.yaw;
  const double scale = wheelbase / kTunedWheelbase;
  const double look = std::clamp(0.5 * left(at), kShortLook * scale, kLongLook * scale);
  // The point on the line to aim at, in the machine's frame; an arc through it is tangent to the
  // machine.
  const double y = sense() * look * std::sin(e) - aside * std::cos(e);
  const double curvature = 2 * y / (look * look + aside * aside);
  return std::clamp(std::atan(wheelbase * curvature), -most_steer, most_steer);
}

double stopping_speed(double left) {
  // v^2 = 2 a s; creep to the end, where the root would never arrive.
  return std::max(kCreep, std::sqrt(2 * kDriveAcceleration * std::max(0.0, left - kStopShort)));
}

double Pursuit::speed_limit(const PlanePose& at) const { return stopping_speed(left(at)); }

PlanePose Pursuit::end_from(PlanePose at, double steer_rate) const {
  constexpr double kStep = 0.02;  // [s]
  // The same law as in the run, on a bicycle whose steering turns as fast as the machine's.
  double v = 0, turned = 0;
  const double patience = 60 + 4 * (target - at.p).norm() / std::max(0.05, std::abs(speed));
  for (double time = 0; left(at) > kStopShort && time < patience; time += kStep) {
    v = std::min({std::abs(speed), v + kDriveAcceleration * kStep, speed_limit(at)});
    turned += std::clamp(steer(at) - turned, -steer_rate * kStep, steer_rate * kStep);
    at.p += sense() * v * kStep * Vec2(std::cos(at.yaw), std::sin(at.yaw));
    at.yaw += sense() * v * kStep * std::tan(turned) / wheelbase;
  }
  return at;
}

}  // namespace navvy::control
