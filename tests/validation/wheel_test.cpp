// SPDX-License-Identifier: Apache-2.0
// The rig `wheel` beside a measured smooth wheel in dry sand. Wheel laws are gated once they are fitted to part of
// the data; the particles are fitted to nothing, so here the load, leaks and the order of the pulls are gated and the
// rest is shown.
#include "lab/run_rig.h"
#include "validation/report.h"

namespace navvy::lab {
namespace {

/// Wheel 125 x 60 mm of Carnegie Mellon's robomechanics rig: slip, load, pull [N], sinkage [mm].
struct Measured {
  double slip, load, pull, sinkage;
};

TEST(WheelLab, SmoothWheelInDrySand) {
  const Measured rows[] = {{-0.5, 23.2, -17.2, 23.3}, {0, 24.6, -1.3, 14.1}, {0.5, 25.3, 1.0, 22.4}};
  double before = -1e9;
  for (const Measured& row : rows) {
    const Report report = run_rig("wheel", {{"slip", row.slip}, {"load-n", row.load}, {"travel", 0.2}});
    validation::expect_gates(report);
    EXPECT_EQ(measured(report, "particles through the wheel"), 0);
    EXPECT_LT(measured(report, "momentum residual"), 1e-5);
    EXPECT_GT(measured(report, "power in: torque x turning less pull x speed"), 0);
    const double pull = measured(report, "drawbar pull"), sinkage = measured(report, "sinkage");
    std::printf("[ VALUE    ] slip %g: pull %.1f of %.1f N, sinkage %.1f of %.1f mm measured\n", row.slip, pull,
                row.pull, sinkage, row.sinkage);
    EXPECT_GT(pull, before) << "pull must grow with slip";
    before = pull;
  }
}

}  // namespace
}  // namespace navvy::lab
