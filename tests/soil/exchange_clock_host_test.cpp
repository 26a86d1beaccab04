// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange_clock.h"

#include <gtest/gtest.h>

namespace navvy::soil {
namespace {

constexpr double kCell = 0.1, kStep = 0.0016;

/// Returns a clock after its first check.
ExchangeClock checked() {
  ExchangeClock clock;
  EXPECT_TRUE(clock.due(0, kCell));
  EXPECT_FALSE(clock.due_by_travel());
  clock.restart();
  return clock;
}

TEST(ExchangeClock, IsDueByTravelBeforeAToolHasMovedThreeTenthsOfACell) {
  ExchangeClock clock = checked();
  for (int i = 0; i < 9; ++i) clock.advance(kStep, 2);
  EXPECT_FALSE(clock.due(0, kCell));
  EXPECT_TRUE(clock.due(2 * kStep, kCell));
  EXPECT_TRUE(clock.due_by_travel());
}

TEST(ExchangeClock, IsDueAfterTwentyFiveStepsWhateverTheTools) {
  ExchangeClock clock = checked();
  for (int i = 0; i < 24; ++i) clock.advance(kStep, 0);
  EXPECT_FALSE(clock.due(0, kCell));
  clock.advance(kStep, 0);
  EXPECT_TRUE(clock.due(0, kCell));
  EXPECT_FALSE(clock.due_by_travel());
}

TEST(ExchangeClock, IsDueAtOnceWhenItIsHurried) {
  ExchangeClock clock = checked();
  clock.hurry();
  EXPECT_TRUE(clock.due(0, kCell));
  EXPECT_FALSE(clock.due_by_travel());
}

}  // namespace
}  // namespace navvy::soil
