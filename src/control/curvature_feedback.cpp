// SPDX-License-Identifier: Apache-2.0
#include "control/curvature_feedback.h"

#include <algorithm>
#include <cmath>

namespace navvy::control {
namespace {

// Time constant of the filters [s]: above the jolts of the wheels, below the turns of the machine.
constexpr double kFilter = 0.1;
// Driven distance, in wheelbases, in which the integral takes up a constant error.
// tuned: Driving.ArrivesBesideItsStart
constexpr double kDistance = 1;
// Greatest correction, as a multiple of the sharpest curvature of the equivalent bicycle. A skid
// steer that turns at a third of its nominal rate needs twice its curvature on top.
constexpr double kMost = 2;
// Share of the wanted yaw rate that may be missing before the machine slows down, and the share at
// which it is slowest. tuned: Driving.ArrivesBesideItsStart
constexpr double kFew = 0.3, kMany = 0.8;
// Share of the greatest correction that a machine on two sides may have while it goes straight.
constexpr double kStraight = 0.05;
constexpr double kLeastEase = 0.3;  // [-]
constexpr double kEaseTime = 0.5;   // [s] as slow as the governors of the sides
constexpr double kSlowTurn = 0.1;   // [rad/s] below which missing turns count for less

}  // namespace

void CurvatureFeedback::begin(const PlanePose& at) {
  *this = {};
  yaw_ = at.yaw;
}

CurvatureFeedback::Steering CurvatureFeedback::correct(const scene::AckermannDrive& bicycle,
                                                       const PlanePose& at, double angle,
                                                       double wanted, double speed, double dt) {
  const double share = dt / (kFilter + dt);
  rate_ += share * (std::remainder(at.yaw - yaw_, 2 * kPi) / dt - rate_);
  rolled_ += share * (speed - rolled_);
  yaw_ = at.yaw;
  // Wheels that are still being turned are no error.
  angle_ += std::clamp(angle - angle_, -bicycle.steer_rate * dt, bicycle.steer_rate * dt);
  // Only the speed difference of two sides turns a machine that stands.
  const bool sides = std::isinf(bicycle.steer_rate);
  const double v = sides ? wanted : rolled_;
  const double rate = std::tan(angle_) / bicycle.wheelbase * v, missing = rate - rate_;
  const double most = kMost * std::tan(bicycle.max_steer) / bicycle.wheelbase;
  integral_ += (v < 0 ? -1 : 1) * missing * dt / (kDistance * bicycle.wheelbase);
  integral_ = std::clamp(integral_, -most, most);
  if (sides) {
    // Sides that skid turn a machine by a share of its command, so nothing is left to correct when
    // it is to go straight.
    const double bound = kMost * std::abs(std::tan(angle)) / bicycle.wheelbase + kStraight * most;
    integral_ = std::clamp(integral_, -bound, bound);
    const double short_of = (rate < 0 ? -missing : missing) / (std::abs(rate) + kSlowTurn);
    const double slow = std::clamp((short_of - kFew) / (kMany - kFew), 0.0, 1.0);
    ease_ += dt / (kEaseTime + dt) * (1 - (1 - kLeastEase) * slow - ease_);
  }
  return {std::atan(std::tan(angle) + integral_ * bicycle.wheelbase), ease_};
}

double forward_speed(const PlanePose& at, const Vec3& v_WB) {
  return v_WB.x() * std::cos(at.yaw) + v_WB.y() * std::sin(at.yaw);
}

}  // namespace navvy::control
