// SPDX-License-Identifier: Apache-2.0
#include "control/turn_in_place.h"

#include <algorithm>
#include <cmath>

#include "scene/drive_kinds.h"

namespace navvy::control {
namespace {

constexpr double kRate = 0.3;         // fastest turn [rad/s]
constexpr double kSlow = radians(2);  // slowest turn [rad/s]
constexpr double kGain = 1;           // of a turn's rate over the angle left [1/s]
constexpr double kStep = radians(5);  // between headings that are checked
constexpr double kAllowance = 10;     // on top of three times the expected time [s]
constexpr double kShortest = 0.3;     // straight path [m]

}  // namespace

bool turns_in_place(const scene::Machine& machine) {
  return machine.has_drive && scene::differential_drive(machine.drive) != nullptr &&
         std::any_of(machine.wheels.begin(), machine.wheels.end(),
                     [](const scene::Wheel& wheel) { return wheel.track.has_value(); });
}

bool can_turn(const PathPlanner& planner, const PlanePose& at, double yaw, double clearance) {
  const double turn = std::remainder(yaw - at.yaw, 2 * kPi),
               least = std::min(clearance, planner.clearance(at, clearance));
  if (least <= 0 && clearance > 0) return false;
  const int steps = static_cast<int>(std::ceil(std::abs(turn) / kStep));
  for (int i = 1; i <= steps; ++i)
    if (planner.clearance({at.p, at.yaw + turn * i / steps}, least) < least) return false;
  return true;
}

namespace {

/// Returns the straight path to the goal of a query, or nothing if the machine has no space for it.
std::optional<Path> straight_path(const PathPlanner& planner, const PathQuery& query) {
  const Vec2 line = query.goal.p - query.start.p;
  const double length = line.norm();
  if (length < kShortest) return std::nullopt;
  const auto turns = [&](double heading) {
    return std::abs(std::remainder(heading - query.start.yaw, 2 * kPi)) +
           std::abs(std::remainder(query.goal.yaw - heading, 2 * kPi));
  };
  const double ahead = std::atan2(line.y(), line.x()), back = ahead + kPi;
  const bool forwards = turns(ahead) <= turns(back);
  const double heading = forwards ? ahead : back;
  const Path out({query.start.p, heading}, {{forwards ? length : -length, 0}});
  const bool clear = can_turn(planner, query.start, heading, query.clearance) &&
                     can_turn(planner, query.goal, heading, query.clearance) &&
                     keeps_clearance(planner, out, 0, query.clearance);
  return clear ? std::optional<Path>(out) : std::nullopt;
}

}  // namespace

std::optional<Path> plan_path(const PathPlanner& planner, const scene::Machine& machine,
                              const PathQuery& query) {
  std::optional<Path> out = planner.plan(query);
  if ((out && out->cusps() == 0) || !turns_in_place(machine)) return out;
  std::optional<Path> straight = straight_path(planner, query);
  return straight ? straight : out;
}

vehicle::DriveInput turn_command(double left) {
  const double rate = std::clamp(kGain * std::abs(left), kSlow, kRate);
  return {0, std::copysign(rate, left), false};
}

double longest_turn(double angle) { return kAllowance + 3 * std::abs(angle) / kRate; }

}  // namespace navvy::control
