// SPDX-License-Identifier: Apache-2.0
#include "record/telemetry.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "record/summary.h"

namespace navvy::record {
namespace {

TEST(Telemetry, StampsOfTwoStepsAreNeverTheSame) {
  for (const double dt : {1e-5, 0.0015847860538827258, 0.02})
    for (const double start : {0.0, 1e2, 1e4, 86400.0, 1e6 - 1}) {
      const auto first = static_cast<std::uint64_t>(start / dt);
      for (std::uint64_t step = first; step < first + 100; ++step)
        EXPECT_NE(time_stamp(static_cast<double>(step) * dt),
                  time_stamp(static_cast<double>(step + 1) * dt))
            << step;
    }
  EXPECT_EQ(time_stamp(10000.02), "10000.02");
}

/// A cycle of 20 s takes 380 bytes in the summary, which is rewritten as a whole: over a day some
/// 10^5 times that.
TEST(Summary, IsRewrittenSoRarelyThatItsBytesGrowLinearlyWithTime) {
  const auto written_by = [](double end) {
    double bytes = 0;
    for (double time = 0; time < end;) {
      const double size = 4000 + 380 * time / 20;
      bytes += size;
      time += std::max(2.0, rewrite_period(static_cast<std::size_t>(size)));
    }
    return bytes;
  };
  EXPECT_LT(written_by(86400), 5000 * 86400 * 1.01);
  EXPECT_NEAR(written_by(2 * 86400) / written_by(86400), 2, 0.1);
  // A short one is updated as often as before.
  EXPECT_LT(rewrite_period(10000), 2.001);
}

}  // namespace
}  // namespace navvy::record
