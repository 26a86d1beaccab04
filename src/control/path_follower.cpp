// SPDX-License-Identifier: Apache-2.0
#include "control/path_follower.h"

#include <algorithm>
#include <cmath>

#include "vehicle/drive/ackermann.h"

namespace navvy::control {
namespace {

// An offset decays over some 1.3 m, nearly without overshoot.
// [1/m^2] tuned: PathFollower.EndsAtTheGoalForwardsBackwardsAndOverCusps
constexpr double kAsideGain = 0.6;
// [1/m] tuned: PathFollower.EndsAtTheGoalForwardsBackwardsAndOverCusps
constexpr double kTurnedGain = 1.4;
// A bend that begins at once becomes one that grows over twice this length [m]: a centimetre of
// offset, and wheels that can follow.
constexpr double kHalf = 0.5;  // [m] tuned: PathFollower.EndsAtTheGoalForwardsBackwardsAndOverCusps
// Share of the wheels' steering rate; the rest is for corrections.
// tuned: PathFollower.EndsAtTheGoalForwardsBackwardsAndOverCusps
constexpr double kRateShare = 0.8;
// Distance [m] in which any bend's speed is reached from 1.4 m/s.
constexpr double kAhead = 2, kAheadStep = 0.25;

}  // namespace

PathFollower::PathFollower(const scene::Drive& drive)
    : bicycle_(vehicle::equivalent_bicycle(drive)),
      most_steer_(vehicle::max_bicycle_angle(bicycle_)) {
  least_radius_ = bicycle_.wheelbase / std::tan(most_steer_);
}

PathPlace PathFollower::place(const Path& path, const PathLeg& leg, const PlanePose& at,
                              double s) const {
  PathPlace out{s, 0, 0};
  // Newton's method for the foot of the perpendicular; its error is 1e-4 of a step that is
  // centimetres long.
  for (int i = 0; i < 3; ++i) {
    const PlanePose on = path.at(out.s);
    const Vec2 forward(std::cos(on.yaw), std::sin(on.yaw)), d = at.p - on.p;
    out.s = std::clamp(out.s + leg.sense * d.dot(forward), leg.begin, leg.end);
  }
  const PlanePose on = path.at(out.s);
  out.aside = (at.p - on.p).dot(Vec2(-std::sin(on.yaw), std::cos(on.yaw)));
  out.turned = std::remainder(at.yaw - on.yaw, 2 * kPi);
  return out;
}

double PathFollower::steer(const Path& path, const PathLeg& leg, const PathPlace& place) const {
  const double ahead = path.curvature(leg, place.s, kHalf);
  const double e = place.aside, t = place.turned;
  // For zero offset this is the path's curvature; its pole is at the bend's centre.
  const double along = ahead * std::cos(t) / std::max(0.2, 1 - ahead * e);
  const double curvature = along - kTurnedGain * leg.sense * t -
                           kAsideGain * (std::abs(t) < 1e-6 ? 1 : std::sin(t) / t) * e;
  return std::clamp(std::atan(bicycle_.wheelbase * curvature), -most_steer_, most_steer_);
}

double PathFollower::steer_at_start(const Path& path, const PathLeg& leg) const {
  return std::clamp(std::atan(bicycle_.wheelbase * path.curvature(leg, leg.begin, kHalf)),
                    -most_steer_, most_steer_);
}

double PathFollower::speed_limit(const Path& path, const PathLeg& leg, double s) const {
  double limit = stopping_speed(leg.end - s);
  const auto angle = [&](double at) {
    return std::atan(bicycle_.wheelbase *
                     path.curvature(leg, std::clamp(at, leg.begin, leg.end), 0));
  };
  for (double ahead = 0; ahead <= kAhead; ahead += kAheadStep) {
    const double turn = std::abs(angle(s + ahead + kHalf) - angle(s + ahead - kHalf));
    if (turn < 1e-6) continue;
    // v^2 = v_bend^2 + 2 a s.
    const double bend = kRateShare * bicycle_.steer_rate * 2 * kHalf / turn;
    limit = std::min(limit, std::sqrt(bend * bend + 2 * kDriveAcceleration * ahead));
  }
  return limit;
}

}  // namespace navvy::control
