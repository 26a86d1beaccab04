// SPDX-License-Identifier: Apache-2.0
#include "run/slice_check.h"

#include <gtest/gtest.h>

#include "control/activities/dig/dig.h"

namespace navvy::run {
namespace {

scene::Scene with_dig(double depth, double pass, double cell) {
  control::Dig dig;
  dig.depth = depth;
  dig.pass_depth = pass;
  scene::Scene scene;
  scene.file = "site.sdf";
  scene.solver.cell = cell;
  scene.machines.resize(1);
  scene.machines[0].name = "digger";
  scene.machines[0].program.steps = {dig};
  scene.machines[0].program.lines = {7};
  return scene;
}

TEST(SliceCheck, WarnsOfSlicesBelowFourCellsWithTheForceToExpect) {
  // Four slices of 0.2 m.
  const std::vector<Fault> faults = check_slices(with_dig(0.8, 0.25, 0.1));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].text(),
            "site.sdf:7: warning: digger/navvy:program/step 1/dig/slice: '0.2 m': is 2.0 cells "
            "deep: a flat blade meets about 85 % of its force there, and 4 cells or more are "
            "advised (pass_depth_m of 0.4, or cell_m of the solver at most 0.05)");
}

TEST(SliceCheck, AcceptsSlicesOfFourCells) {
  EXPECT_TRUE(check_slices(with_dig(0.8, 0.4, 0.1)).empty());
  EXPECT_TRUE(check_slices(with_dig(0.8, 0.25, 0.05)).empty());
  EXPECT_TRUE(check_slices(scene::Scene()).empty());
}

TEST(SliceCheck, AdvisesNoThickerSlicesThanTheCutIsDeep) {
  const std::vector<Fault> faults = check_slices(with_dig(0.3, 0.5, 0.1));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].remedy, "cell_m of the solver at most 0.075");
}

TEST(SliceCheck, InterpolatesTheMeasuredShares) {
  EXPECT_DOUBLE_EQ(force_share(2), 0.85);
  EXPECT_NEAR(force_share(2.5), 0.89, 1e-12);
  EXPECT_DOUBLE_EQ(force_share(3), 0.93);
  EXPECT_LT(force_share(0.5), 0.5);
  EXPECT_GT(force_share(0.2), 0);
  EXPECT_DOUBLE_EQ(force_share(20), 1);
}

}  // namespace
}  // namespace navvy::run
