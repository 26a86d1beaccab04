// SPDX-License-Identifier: Apache-2.0
#include "record/telemetry.h"

#include <gtest/gtest.h>

namespace navvy::record {
namespace {

TEST(Telemetry, StampsOfTwoStepsAreNeverTheSame) {
  for (const double dt : {1e-5, 0.0015847860538827258, 0.02})
    for (const double start : {0.0, 1e2, 1e4, 86400.0, 1e6 - 1}) {
      const auto first = static_cast<std::uint64_t>(start / dt);
      for (std::uint64_t step = first; step < first + 100; ++step)
        EXPECT_NE(time_stamp(static_cast<double>(step) * dt), time_stamp(static_cast<double>(step + 1) * dt)) << step;
    }
  EXPECT_EQ(time_stamp(10000.02), "10000.02");
}

}  // namespace
}  // namespace navvy::record
