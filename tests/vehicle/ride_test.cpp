// SPDX-License-Identifier: Apache-2.0
// Evenness of the shipped excavator's wheel loads on flat firm ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::ew180;
using testing::flat;
using testing::run;

TEST(Ride, WheelLoadsOnFirmGroundKeepWithinTenPercentOfTheirMean) {
  constexpr double kStep = 1.0 / 600;
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(ew180(), Pose::Identity());
  run(*engine, flat(), 2, kStep);
  engine->set_drive(0, {1.2, 0, false});
  run(*engine, flat(), 3, kStep);
  std::array<double, 4> sum{}, squares{}, most{}, least{1e9, 1e9, 1e9, 1e9};
  int samples = 0;
  run(*engine, flat(), 10, kStep, [&](double) {
    for (std::size_t w = 0; w < 4; ++w) {
      const double load = engine->wheel(0, static_cast<int>(w)).force_W.z();
      sum[w] += load;
      squares[w] += load * load;
      most[w] = std::max(most[w], load);
      least[w] = std::min(least[w], load);
    }
    ++samples;
  });
  for (std::size_t w = 0; w < 4; ++w) {
    const double mean = sum[w] / samples,
                 rms = std::sqrt(std::max(0.0, squares[w] / samples - mean * mean));
    print_value("wheel " + std::to_string(w) + " at 1.2 m/s: rms / mean of its load [-]",
                rms / mean,
                "0.1; mean " + std::to_string(mean) + " N, " + std::to_string(least[w]) + " to " +
                    std::to_string(most[w]),
                "even ride");
    EXPECT_LT(rms, 0.1 * mean);
  }
}

}  // namespace
}  // namespace navvy::vehicle
