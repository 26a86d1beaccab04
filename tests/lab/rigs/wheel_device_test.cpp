// SPDX-License-Identifier: Apache-2.0
// A wheel on particles, four cells of radius; the wheel of the experiment runs in
// tests/validation/wheel_test.cpp.
#include "core/error.h"
#include "core/math.h"
#include "lab/run_rig.h"

namespace navvy::lab {
namespace {

Report roll(double slip, double delta_degrees) {
  return run_rig("wheel",
                 {{"radius", 0.4},
                  {"width", 0.4},
                  {"load-n", 600},
                  {"slip", slip},
                  {"speed", 0.5},
                  {"travel", 0.8},
                  {"from", 0.4},
                  {"beside", 1},
                  {"below", 1.2}},
                 [delta_degrees](lab::Setup& s) {
                   s.cell = 0.1;
                   s.soil.tool_friction_angle = radians(delta_degrees);
                 });
}

TEST(LabWheel, CarriesItsLoadAndPullsMoreWithSlip) {
  double before = -1e9;
  // A locked wheel would continue to sink.
  for (const double slip : {-0.5, 0.0, 0.5}) {
    const Report report = roll(slip, 20);
    EXPECT_EQ(outside_tolerance(report), "") << slip;
    EXPECT_EQ(measured(report, "particles through the wheel"), 0) << slip;
    EXPECT_LT(measured(report, "momentum residual"), 1e-5) << slip;
    EXPECT_GT(measured(report, "power in: torque x turning less pull x speed"), 0) << slip;
    EXPECT_EQ(report.ledger_error, 0) << slip;
    EXPECT_GT(measured(report, "drawbar pull"), before) << slip;
    before = measured(report, "drawbar pull");
  }
}

TEST(LabWheel, SmoothWheelHasNoTorque) {
  const Report report = roll(0.5, 0);
  // Facets of 7.5 degrees, no shear
  EXPECT_NEAR(measured(report, "torque over radius x load"), 0, 0.02);
  EXPECT_LT(measured(report, "drawbar pull"), 0);
}

TEST(LabWheel, LockedWheelDragsAtLeastItsFriction) {
  const Report report = roll(-1, 20);
  EXPECT_LT(measured(report, "drawbar pull"), -std::tan(radians(20)) * 600);
}

TEST(LabWheel, RefusesImpossibleWheels) {
  EXPECT_THROW(roll(0.99, 20), InputError);
  EXPECT_THROW(run_rig("wheel", {{"radius", 0.02}}), InputError);
}

}  // namespace
}  // namespace navvy::lab
