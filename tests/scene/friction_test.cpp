// SPDX-License-Identifier: Apache-2.0
#include "scene/friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "scene/soil_values.h"

namespace navvy::scene {
namespace {

double phi_of(FrictionTest test, double angle, double psi = 0) {
  return degrees(plane_strain_angle(test, radians(angle), radians(psi)));
}

// By hand: tan 35 / cos 30 = tan 38.96; sin 44.44 = tan 35; sin 33.66 = tan 29; with psi 10 deg
// sin phi = tan 35 / (cos 10 + tan 35 sin 10).
TEST(Friction, ConvertsEachTestToPlaneStrain) {
  EXPECT_NEAR(phi_of(FrictionTest::kTriaxial, 35), 38.957, 1e-3);
  EXPECT_NEAR(phi_of(FrictionTest::kDirectShear, 35), 44.443, 1e-3);
  EXPECT_NEAR(phi_of(FrictionTest::kRepose, 29), 33.663, 1e-3);
  EXPECT_EQ(phi_of(FrictionTest::kPlaneStrain, 35), degrees(radians(35)));
  EXPECT_NEAR(phi_of(FrictionTest::kDirectShear, 35, 10), 39.262, 1e-3);
  EXPECT_NEAR(phi_of(FrictionTest::kRepose, 29, 10), 33.663, 1e-3) << "a heap is loose";
}

TEST(Friction, AssociatedFlowGivesTheTangentInDirectShear) {
  EXPECT_NEAR(degrees(angle_in_test(FrictionTest::kDirectShear, radians(30), radians(30))), 30,
              1e-9);
}

TEST(Friction, EveryConversionIsTheInverseOfTheTest) {
  for (const auto& [name, test] : kFrictionTests)
    for (const double psi : {0.0, 5.0, 15.0, 30.0})
      for (const double phi : {0.0, 10.0, 30.0, 45.0, 50.0}) {
        const double angle = degrees(angle_in_test(test, radians(phi), radians(psi)));
        EXPECT_NEAR(phi_of(test, angle, psi), phi, 1e-6) << name << " " << phi << " " << psi;
      }
}

TEST(Friction, TriaxialAnglesAreThoseOfMatsuokaAndNakai) {
  // tan^2 of the angle is (I1 I2 / I3 - 9) / 8 with the invariants of plane strain.
  for (const double phi : {20.0, 35.0, 50.0}) {
    const double s = std::sin(radians(phi)), kappa = (9 - 3 * s * s) / (1 - s * s);
    EXPECT_NEAR(angle_in_test(FrictionTest::kTriaxial, radians(phi), 0),
                std::atan(std::sqrt((kappa - 9) / 8)), 1e-9);
  }
}

TEST(Friction, AnglesAboveTheLimitAreFaults) {
  EXPECT_FALSE(check_friction(FrictionTest::kPlaneStrain, radians(50), 0));
  EXPECT_FALSE(check_friction(FrictionTest::kDirectShear, radians(37.4), 0));
  EXPECT_FALSE(check_friction(FrictionTest::kDirectShear, radians(40), radians(12)));
  // No soil measures this much: sin phi would be 1.19.
  for (const double angle : {37.5, 40.0, 50.0}) {
    const auto refused = check_friction(FrictionTest::kDirectShear, radians(angle), 0);
    ASSERT_TRUE(refused) << angle;
    EXPECT_NE(refused->text().find("above the limit of 50 deg in plane strain, which measures 37.5 "
                                   "deg in a test of type direct_shear"),
              std::string::npos)
        << refused->text();
  }
  EXPECT_TRUE(check_friction(FrictionTest::kTriaxial, radians(46), 0));
  EXPECT_TRUE(check_friction(FrictionTest::kRepose, radians(38), 0));
}

TEST(Friction, FollowsTheDilatancyOfItsSoil) {
  Soil soil;
  EXPECT_FALSE(follow_friction_test(soil));
  EXPECT_EQ(soil.friction_angle, Soil{}.friction_angle) << "a bare angle stays as it is";
  soil.friction_test = FrictionTest::kDirectShear;
  soil.tested_friction_angle = radians(35);
  EXPECT_FALSE(follow_friction_test(soil));
  EXPECT_NEAR(degrees(soil.friction_angle), 44.443, 1e-3);
  soil.dilatancy_angle = radians(10);
  EXPECT_FALSE(follow_friction_test(soil));
  EXPECT_NEAR(degrees(soil.friction_angle), 39.262, 1e-3);
  soil.tested_friction_angle = radians(45);
  soil.dilatancy_angle = 0;
  EXPECT_TRUE(follow_friction_test(soil));
  EXPECT_NEAR(degrees(soil.friction_angle), 39.262, 1e-3) << "a fault leaves it";
}

}  // namespace
}  // namespace navvy::scene
