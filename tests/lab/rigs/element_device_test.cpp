// SPDX-License-Identifier: Apache-2.0
// Small versions of the element rigs. The rigs contain the tolerances; the behaviour of the present
// law in a triaxial sample is checked here.
#include <cmath>

#include "core/math.h"
#include "lab/run_rig.h"

namespace navvy::lab {
namespace {

TEST(LabShear, SampleMobilisesTheSineOfItsFriction) {
  const Report report = run_rig("shear", {{"edge", 6}, {"speed", 0.2}});
  // A smaller cube whose plates are closer: 3 % where the rig's own size has 1 %.
  EXPECT_NEAR(measured(report, "tau over sigma / sin phi"), 1, 0.03);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabTriaxial, CompressionAndExtensionMobiliseAnAngleBelowOrAboveThePlaneOne) {
  const auto angle = [](double path) {
    return measured(run_rig("triaxial", {{"path", path}}), "mobilised friction angle");
  };
  const double compression = angle(0), extension = angle(1);
  // The mean over the middle of a cube of 8 cells is 0.3 to 0.4 deg above the law itself, which
  // tests of the law check to a hundredth; for 6 cells 0.8. A circular cone matched at phi 35 in
  // plane strain has 25.2 and 36.5 deg; the surface of Matsuoka and Nakai 31.2 in both. Any law
  // between them mobilises an angle between these.
  EXPECT_GT(compression, 24.5);
  EXPECT_LT(compression, 31.8);
  EXPECT_GT(extension, 30.6);
  EXPECT_LT(extension, 37.2);
}

}  // namespace
}  // namespace navvy::lab
