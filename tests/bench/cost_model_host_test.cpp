// SPDX-License-Identifier: Apache-2.0
#include "bench/cost_model.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"

namespace navvy::bench {
namespace {

/// Returns a row of 10 steps that takes what `cost` says.
Row row(double blocks, std::uint64_t particles, double nodes, const CostModel& cost) {
  Row out;
  out.particles = particles;
  out.steps = 10;
  out.active_blocks = blocks;
  out.contact_nodes = nodes;
  out.timing.processor = 10 * cost.step_seconds(out);
  out.timing.best = out.timing.processor;
  return out;
}

std::vector<Row> rows_of(const CostModel& cost) {
  return {row(150, 2500, 8000, cost), row(400, 29000, 6000, cost), row(4000, 403000, 6000, cost),
          row(200, 8000, 0, cost),    row(1500, 64000, 0, cost),   row(9000, 512000, 0, cost)};
}

TEST(CostModel, FindsThePartsThatTheRowsWereMadeOf) {
  const CostModel cost{2e-4, 3e-6, 2e-8, 1e-7};
  const CostModel found = fit_cost(rows_of(cost));
  EXPECT_NEAR(found.step, cost.step, 1e-9);
  EXPECT_NEAR(found.block, cost.block, 1e-11);
  EXPECT_NEAR(found.particle, cost.particle, 1e-13);
  EXPECT_NEAR(found.node, cost.node, 1e-12);
  EXPECT_LT(found.worst, 1e-6);
}

TEST(CostModel, HasNoNegativePart) {
  std::vector<Row> rows = rows_of({2e-4, 0, 2e-8, 1e-7});
  // Rows with many blocks come out faster than the others say.
  for (Row& each : rows)
    if (each.active_blocks > 1000) each.timing.processor *= 0.8;
  const CostModel found = fit_cost(rows);
  EXPECT_GE(found.step, 0);
  EXPECT_EQ(found.block, 0);
  EXPECT_GT(found.particle, 0);
  EXPECT_GE(found.node, 0);
  EXPECT_TRUE(found.worst > 0.01 && found.worst < 0.4) << found.worst;
}

TEST(CostModel, NeedsAsManyRowsAsParts) {
  std::vector<Row> rows = rows_of({2e-4, 3e-6, 2e-8, 1e-7});
  for (std::size_t i = 3; i < rows.size(); ++i) rows[i].timing.processor = 0;
  EXPECT_THROW(fit_cost(rows), InputError);
}

TEST(CostModel, WallShareIsTheMedianOfTheRowsInItsRange) {
  std::vector<Row> rows = rows_of({2e-4, 3e-6, 2e-8, 1e-7});
  for (Row& each : rows)
    if (each.particles > 20000) each.timing.best = 0.6 * each.timing.processor;
  EXPECT_DOUBLE_EQ(wall_share(rows, 0, 20000), 1);
  EXPECT_DOUBLE_EQ(wall_share(rows, 20000, 1e9), 0.6);
  EXPECT_DOUBLE_EQ(wall_share(rows, 1e9, 2e9), 1);
}

}  // namespace
}  // namespace navvy::bench
