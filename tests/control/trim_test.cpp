// SPDX-License-Identifier: Apache-2.0
// Surplus of a scoop that falls back before the bucket swings to a bed.
#include "control/activities/dig/trim.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace navvy::control {
namespace {

constexpr double kStep = 0.01;  // [s]

/// Advances until the bucket is closed again. The soil of a bucket opened by more than 0.9 rad
/// leaves it at 100 kg/s. Returns what is left of `payload` [kg].
double trimmed(Trim& trim, double payload, double most, double& time) {
  for (time = 0; time < 60 && trim.advance(payload, most, kStep); time += kStep)
    if (trim.opening() > 0.9) payload = std::max(0.0, payload - 100 * kStep);
  return payload;
}

TEST(Trim, OpensUntilTheLoadIsNoMoreThanWantedAndClosesAgain) {
  Trim trim;
  trim.start();
  double time = 0;
  const double left = trimmed(trim, 900, 600, time);
  EXPECT_NEAR(left, 600, 60) << "what falls while it closes is foreseen";
  EXPECT_EQ(trim.opening(), 0);
  EXPECT_GT(time, 5);
  // It does not open again for this scoop, but for the next one.
  EXPECT_FALSE(trim.advance(900, 600, kStep));
  trim.start();
  EXPECT_TRUE(trim.advance(900, 600, kStep));
}

TEST(Trim, LeavesALoadAloneThatIsNotTooLarge) {
  Trim trim;
  trim.start();
  EXPECT_FALSE(trim.advance(600, 600, kStep));
  EXPECT_EQ(trim.opening(), 0);
}

TEST(Trim, ClosesWhenTheSoilDoesNotFall) {
  Trim trim;
  trim.start();
  double time = 0;
  while (trim.advance(900, 600, kStep) && time < 60) time += kStep;
  EXPECT_LT(time, 15);
  EXPECT_EQ(trim.opening(), 0);
}

}  // namespace
}  // namespace navvy::control
