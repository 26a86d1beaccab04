// SPDX-License-Identifier: Apache-2.0
#include "control/path_planner.h"

#include <algorithm>
#include <cmath>

namespace navvy::control {

double clearance_along(const PathPlanner& planner, const Path& path, double s, double range,
                       double enough) {
  constexpr double kStep = 0.1;  // [m]
  const double remaining = std::max(0.0, path.length() - s);
  const int steps = static_cast<int>(std::ceil(remaining / kStep));
  double least = range;
  // Both ends are sampled.
  for (int i = 0; i <= steps && least >= enough; ++i)
    least = std::min(least,
                     planner.clearance(path.at(i < steps ? s + i * kStep : path.length()), range));
  return least;
}

}  // namespace navvy::control
