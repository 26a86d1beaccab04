// SPDX-License-Identifier: Apache-2.0
// Path planners for tests of operators.
#pragma once

#include <optional>

#include "control/path_planner.h"

namespace navvy::control::testing {

/// Plans straight ahead on ground that is drivable everywhere.
class StraightPlanner final : public PathPlanner {
 public:
  void look(const SurfaceView&) override {}
  double clearance(const PlanePose&, double range) const override { return range; }
  double length() const override { return 4; }
  std::optional<Path> plan(const PathQuery& query) const override {
    return Path(query.start, {{(query.goal.p - query.start.p).norm(), 0}});
  }
};

/// Finds no path at all.
class BlockedPlanner final : public PathPlanner {
 public:
  void look(const SurfaceView&) override {}
  double clearance(const PlanePose&, double) const override { return 0; }
  double length() const override { return 4; }
  std::optional<Path> plan(const PathQuery&) const override { return std::nullopt; }
};

}  // namespace navvy::control::testing
