// SPDX-License-Identifier: Apache-2.0
#include "control/path_planner.h"

#include <algorithm>
#include <cmath>

namespace navvy::control {

double clearance_near(const PathPlanner& planner, const PlanePose& start, double clearance) {
  const double here = planner.clearance(start, clearance);
  return here > 0 && here < clearance ? std::min(here, kLeastClearance) : clearance;
}

bool is_near(const PathPlanner& planner, const PlanePose& at, const PlanePose& start) {
  return (at.p - start.p).norm() <= 2 * planner.length();
}

bool keeps_clearance(const PathPlanner& planner, const Path& path, double s, double clearance) {
  constexpr double kStep = 0.1;  // [m]
  const PlanePose& start = path.start();
  const double near = clearance_near(planner, start, clearance);
  const int steps = static_cast<int>(std::ceil(std::max(0.0, path.length() - s) / kStep));
  // Both ends are sampled.
  for (int i = 0; i <= steps; ++i) {
    const PlanePose at = path.at(i < steps ? s + i * kStep : path.length());
    const double least = is_near(planner, at, start) ? near : clearance;
    // A greater clearance need not be known, so it is the range, too.
    if (planner.clearance(at, least) < least) return false;
  }
  return true;
}

}  // namespace navvy::control
