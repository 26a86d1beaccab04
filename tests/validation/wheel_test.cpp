// SPDX-License-Identifier: Apache-2.0
// The rig `wheel` compared with a measured smooth wheel in dry sand. Wheel laws have tolerances
// once they are fitted to part of the data; the particles are not fitted, so here the load, leaks
// and the order of the pulls have tolerances and the rest is printed.
#include "lab/run_rig.h"
#include "validation/courant.h"
#include "validation/report.h"
#include "values.h"

namespace navvy::lab {
namespace {

/// Wheel 125 x 60 mm of Carnegie Mellon's robomechanics rig: slip, load, pull [N], sinkage [mm].
struct Measured {
  double slip, load, pull, sinkage;
};

TEST(WheelLab, CarriesASmoothWheelInDrySand) {
  const Measured rows[] = {
      {-0.5, 23.2, -17.2, 23.3}, {0, 24.6, -1.3, 14.1}, {0.5, 25.3, 1.0, 22.4}};
  double before = -1e9;
  for (const Measured& row : rows) {
    const Report report =
        run_rig("wheel", {{"slip", row.slip}, {"load-n", row.load}, {"travel", 0.2}});
    validation::expect_tolerances(report);
    EXPECT_EQ(measured(report, "particles through the wheel"), 0);
    EXPECT_LT(measured(report, "momentum residual"), 1e-5);
    EXPECT_GT(measured(report, "power in: torque x turning less pull x speed"), 0);
    const double pull = measured(report, "drawbar pull"), sinkage = measured(report, "sinkage");
    std::printf("[ VALUE    ] slip %g: pull %.1f of %.1f N, sinkage %.1f of %.1f mm measured\n",
                row.slip, pull, row.pull, sinkage, row.sinkage);
    EXPECT_GT(pull, before) << "pull must grow with slip";
    before = pull;
  }
}

// Effect of step and speed on a wheel on particles; pull and sinkage themselves have no tolerance.
TEST(WheelLab, ReportsASmoothWheelOverSpeedsAndSteps) {
  const auto wheel = [](double speed, double courant) {
    const Report report = run_rig("wheel", {{"slip", 0.5},
                                            {"load-n", 25.3},
                                            {"from", 0.05},
                                            {"travel", 0.1},
                                            {"speed", speed},
                                            {"courant", courant}});
    EXPECT_EQ(measured(report, "particles through the wheel"), 0);
    const std::string name =
        "wheel at slip 0.5, " + short_text(speed) + " m/s, Courant " + short_text(courant);
    print_value(name + ": pull [N]", measured(report, "drawbar pull"), "1.0 measured, no tolerance",
                "[docs/validation.md, Wheels]");
    print_value(name + ": sinkage [mm]", measured(report, "sinkage"), "22.4 measured, no tolerance",
                "[docs/validation.md, Wheels]");
    return measured(report, "sinkage");
  };
  const double usual = wheel(0.2, validation::kUsualCourant);
  validation::expect_between("wheel at slip 0.5: sinkage at half the step / at the step",
                             wheel(0.2, validation::kHalfCourant) / usual, 0.97, 1.03,
                             "the step [docs/validation.md, speed and step]");
  validation::expect_between("wheel at slip 0.5: sinkage at 0.07 m/s / at 0.2 m/s",
                             wheel(0.07, validation::kUsualCourant) / usual, 0.95, 1.05,
                             "[docs/validation.md, speed and step]");
}

}  // namespace
}  // namespace navvy::lab
