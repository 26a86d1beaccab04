// SPDX-License-Identifier: Apache-2.0
// The base step divides the control period, and samples fall on the nearest step for the longest
// possible run.
#include "sim/timing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace navvy::sim {
namespace {

// Step of the shipped scenes at a cell of 0.1 m; no rate below divides it.
constexpr double kLongest = 0.0015847860538827258;
constexpr double kDay = 86400;

TEST(Timing, TheBaseStepDividesTheControlPeriod) {
  for (const double rate : {500.0, 20.0, 7.0, 1000.0, 50.0, 631.0, 0.5}) {
    const double dt = base_step(kLongest, 1 / rate), steps = 1 / (rate * dt);
    EXPECT_NEAR(steps, std::round(steps), 1e-9) << rate << " Hz";
    EXPECT_LE(dt, kLongest * (1 + 1e-9)) << rate << " Hz";
    // Not shorter than necessary: with one step fewer it would be too long.
    if (steps > 1.5) EXPECT_GT(1 / rate / (std::round(steps) - 1), kLongest) << rate << " Hz";
  }
  EXPECT_DOUBLE_EQ(base_step(kLongest, 1 / 500.0), 0.001);
  EXPECT_DOUBLE_EQ(base_step(kLongest, 1 / 1000.0), 0.001);
  EXPECT_EQ(base_step(kLongest, 0), kLongest);
}

TEST(Timing, AStepThatAlreadyDividesThePeriodIsUnchanged) {
  for (const int steps : {1, 3, 7, 12, 49, 93})
    EXPECT_NEAR(base_step(0.02 / steps, 0.02), 0.02 / steps, 1e-17) << steps;
}

TEST(Timing, SamplesOfADayAreNeverFartherThanHalfAStep) {
  for (const double rate : {50.0, 20.0, 7.0, 4.0, 500.0, 0.3}) {
    // Checked around many times of the day; walking through all of its 5e7 steps would prove
    // nothing more.
    for (std::uint64_t n = 0; static_cast<double>(n) / rate < kDay; n = n * 3 / 2 + 1) {
      const double time = static_cast<double>(n) / rate;
      const auto step = static_cast<std::uint64_t>(std::llround(time / kLongest));
      EXPECT_TRUE(sample_due(step, kLongest, rate)) << rate << " Hz, sample " << n;
      EXPECT_LE(sample_number(step, kLongest, rate), n) << rate << " Hz";
      EXPECT_GT(samples_through(step, kLongest, rate), n) << rate << " Hz";
      EXPECT_LE(std::abs(static_cast<double>(step) * kLongest - time), 0.5 * kLongest + 1e-9)
          << rate << " Hz";
    }
  }
}

TEST(Timing, NoSampleOfALongRunIsLostOrTakenTwice) {
  for (const double rate : {50.0, 20.0, 7.0, 500.0}) {
    std::uint64_t taken = 0;
    constexpr std::uint64_t kSteps = 2'000'000;  // 53 minutes
    for (std::uint64_t step = 0; step <= kSteps; ++step) {
      if (!sample_due(step, kLongest, rate)) continue;
      EXPECT_EQ(sample_number(step, kLongest, rate), taken);
      ++taken;
    }
    EXPECT_EQ(taken, samples_through(kSteps, kLongest, rate));
    EXPECT_NEAR(static_cast<double>(taken), static_cast<double>(kSteps) * kLongest * rate + 1, 1);
  }
}

TEST(Timing, ControlStepsFallOnTheStepsThatDivideTheirPeriodForADay) {
  for (const double rate : {500.0, 20.0, 7.0, 1000.0}) {
    const double dt = base_step(kLongest, 1 / rate);
    const auto every = static_cast<std::uint64_t>(std::llround(1 / (rate * dt)));
    for (std::uint64_t n = 0; static_cast<double>(n) / rate < kDay; n = n * 5 / 4 + 1) {
      EXPECT_TRUE(sample_due(n * every, dt, rate)) << rate << " Hz, " << n;
      if (every > 1) EXPECT_FALSE(sample_due(n * every + 1, dt, rate)) << rate << " Hz, " << n;
      EXPECT_EQ(sample_number(n * every, dt, rate), n) << rate << " Hz";
      EXPECT_NEAR(static_cast<double>(n * every) * dt, static_cast<double>(n) / rate, 1e-9)
          << rate << " Hz";
    }
  }
}

TEST(Timing, ARateAboveThatOfStepsSamplesEveryStep) {
  for (std::uint64_t step = 0; step < 1000; ++step) EXPECT_TRUE(sample_due(step, kLongest, 1e5));
  EXPECT_EQ(sample_number(0, kLongest, 1e5), 0u);
}

}  // namespace
}  // namespace navvy::sim
