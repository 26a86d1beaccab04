// SPDX-License-Identifier: Apache-2.0
// Small versions of the element rigs. The rigs contain the tolerances; the behaviour of the present
// law in a triaxial sample is checked here.
#include <cmath>

#include "core/math.h"
#include "lab/run_rig.h"
#include "lab/soils.h"
#include "scene/soil_values.h"

namespace navvy::lab {
namespace {

TEST(LabShear, SampleMobilisesTheSineOfItsFriction) {
  const Report report = run_rig("shear", {{"edge", 6}, {"speed", 0.2}});
  // A smaller cube whose plates are closer: 3 % where the rig's own size has 1 %.
  EXPECT_NEAR(measured(report, "tau over sigma / sin phi"), 1, 0.03);
  EXPECT_EQ(report.ledger_error, 0);
}

/// Runs a rig of its own size in sand whose friction angle `test` measured as 35 deg. The rig has
/// the tolerance, 1 deg.
void expect_given_angle(const char* rig, scene::FrictionTest test) {
  const Report report = run_rig(rig, {}, [test](lab::Setup& s) {
    set_friction(s.soil, test, radians(35));
    ASSERT_FALSE(scene::follow_friction_test(s.soil));
  });
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_TRUE(report.find("angle of the test that was given")->judged());
  EXPECT_NEAR(measured(report, "angle of the test that was given"), 35, 1);
}

TEST(LabShear, ReturnsTheAngleOfADirectShearTest) {
  expect_given_angle("shear", scene::FrictionTest::kDirectShear);
}

TEST(LabTriaxial, ReturnsTheAngleOfATriaxialTest) {
  expect_given_angle("triaxial", scene::FrictionTest::kTriaxial);
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
