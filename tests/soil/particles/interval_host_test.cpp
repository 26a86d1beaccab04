// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/interval.h"

#include <gtest/gtest.h>

namespace navvy::soil {
namespace {

constexpr double kCell = 0.1, kLength = 6e-3;

/// Returns the number of steps of dt [s] in one transfer at these speeds [m/s].
int steps_of(double dt, double soil, double tool, double gravity = 0) {
  TransferInterval interval;
  int steps = 0;
  do {
    interval.count_step(dt, kCell, soil, tool);
    ++steps;
  } while (interval.holds(dt, kLength, kCell, tool, gravity));
  return steps;
}

TEST(TransferInterval, TakesAsManyStepsAsItsLengthHolds) {
  EXPECT_FALSE(TransferInterval{}.holds(1e-3, kLength, kCell, 0, 0)) << "nothing to hold";
  EXPECT_EQ(steps_of(1.5e-3, 0, 0), 4);
  EXPECT_EQ(steps_of(0.75e-3, 0, 0), 8);
  EXPECT_EQ(steps_of(1.45e-3, 0, 0), 4);  // to the nearest: four are 5.8 ms
  EXPECT_EQ(steps_of(1.8e-3, 0, 0), 3);   // three are 5.4 ms, four 7.2
  EXPECT_EQ(steps_of(10e-3, 0, 0), 1);
}

TEST(TransferInterval, EndsBeforeSoilOrAToolHasGoneAFifthOfACell) {
  // 0.2 cells of 0.1 m at 5 m/s take 4 ms.
  EXPECT_EQ(steps_of(1.5e-3, 5, 0), 2);
  EXPECT_EQ(steps_of(1.5e-3, 0, 5), 2);
  EXPECT_EQ(steps_of(1.5e-3, 20, 0), 1);
  // Soil that falls from rest gains 15 mm/s per step at 1 g, no reason to end; at 100 g it is.
  EXPECT_EQ(steps_of(1.5e-3, 3, 0, 9.81), 4);
  EXPECT_EQ(steps_of(1.5e-3, 3, 0, 981), 3);
}

}  // namespace
}  // namespace navvy::soil
