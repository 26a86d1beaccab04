// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "record/recorder.h"

namespace navvy::record {
namespace {

TEST(RunProgress, TimeLeftIsSimulatedTimeOverRealTimeFactor) {
  EXPECT_EQ(wall_time_left(30, 2), 15);
  EXPECT_EQ(wall_time_left(30, 0), 0);
}

TEST(RunProgress, TimeLeftIsNeverNegativeZero) {
  // The last step of a run may end a rounding error after its duration.
  for (const double simulated : {-1e-9, -0.0, 0.0}) {
    EXPECT_EQ(wall_time_left(simulated, 1.5), 0);
    EXPECT_FALSE(std::signbit(wall_time_left(simulated, 1.5))) << simulated;
  }
}

}  // namespace
}  // namespace navvy::record
