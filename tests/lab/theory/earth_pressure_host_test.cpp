// SPDX-License-Identifier: Apache-2.0
// Passive pressure of rough walls compared with published values, or with independently computed
// values.
#include "lab/theory/earth_pressure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"

namespace navvy::lab {
namespace {

double kc(double phi_degrees, double delta_degrees) {
  return passive_slip_line(radians(phi_degrees), radians(delta_degrees), 1, 0, 0).normal;
}

TEST(SlipLine, CohesionCoefficientsMatchTheirTable) {
  // Values of the exact field, to three digits; the planar wedge has 3.46, 4.78, 6.96, 11.2. The
  // last one by hand: the fan turns by 40.6 deg, p = 7.85 c.
  const double deltas[] = {0, 10, 20, 30}, coefficients[] = {3.46, 4.60, 5.78, 6.72};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(kc(30, deltas[i]), coefficients[i], 6e-3) << deltas[i];
}

TEST(SlipLine, OfClayMatchesPrandtlsFan) {
  // phi = 0: sigma_n = c (1 + 2 t + cos 2t) with sin 2t = a / c: 2 c smooth, (1 + pi / 2) c rough.
  EXPECT_NEAR(kc(0, 0), 2, 1e-3);
  EXPECT_NEAR(passive_slip_line(0, 0, 1, 1, 0).normal, 1 + kPi / 2, 1e-3);
  EXPECT_NEAR(passive_slip_line(0, 0, 1, 1, 0).shear, 1, 1e-3);
  EXPECT_NEAR(passive_slip_line(0, 0, 1, 0.5, 0).normal, 1 + kPi / 6 + std::cos(kPi / 6), 1e-3);
}

TEST(SlipLine, ObeysTheWallFriction) {
  for (const double delta : {0.0, 5.0, 12.0, 19.0}) {
    const WallStress s = passive_slip_line(radians(28), radians(delta), 4000, 900, 2500);
    EXPECT_NEAR(s.shear, 900 + s.normal * std::tan(radians(delta)), 1e-3) << delta;
  }
  // Rougher than the soil: the soil slips internally, and further roughness has no effect.
  EXPECT_EQ(kc(30, 45), kc(30, 60));
}

TEST(SlipLine, OfASurchargeMatchesLancellotta) {
  // His lower bound for the weight equals the weightless field under a surcharge.
  for (const double delta : {0.0, 10.0, 20.0, 30.0})
    EXPECT_NEAR(passive_slip_line(radians(30), radians(delta), 0, 0, 1).normal,
                passive_lancellotta(radians(30), radians(delta)), 1e-4)
        << delta;
}

TEST(Lancellotta, MatchesItsValueAndRankine) {
  EXPECT_NEAR(passive_lancellotta(radians(30), radians(20)), 4.63, 5e-3);
  EXPECT_NEAR(passive_lancellotta(radians(35), 0), rankine_passive(radians(35)), 1e-9);
}

TEST(LogSpiral, MatchesTheTablesOfCaquotAndKerisel) {
  // The total force, along delta [Caquot 1948]; chart values, to two digits.
  const auto whole = [](double phi, double delta) {
    return passive_log_spiral(radians(phi), radians(delta)) / std::cos(radians(delta));
  };
  EXPECT_NEAR(whole(30, 10), 4.0, 0.02 * 4.0);
  EXPECT_NEAR(whole(30, 20), 5.3, 0.02 * 5.3);
  EXPECT_NEAR(whole(30, 30), 6.5, 0.05 * 6.5);
  EXPECT_NEAR(whole(35, 35.0 / 3), 5.4, 0.02 * 5.4);
  EXPECT_NEAR(whole(40, 40.0 / 3), 7.5, 0.02 * 7.5);
}

TEST(LogSpiral, OfASmoothWallMatchesRankine) {
  for (const double phi : {20.0, 30.0, 40.0})
    EXPECT_NEAR(passive_log_spiral(radians(phi), 0) / rankine_passive(radians(phi)), 1, 2e-3)
        << phi;
}

TEST(LogSpiral, IsBetweenTheLowerBoundAndThePlanarWedge) {
  BladeCase blade;
  blade.rake = kPi / 2, blade.depth = 1, blade.unit_weight = 2;
  for (const double phi : {25.0, 30.0, 35.0, 40.0})
    for (const double share : {0.2, 0.5, 0.8}) {
      blade.phi = radians(phi), blade.delta = share * blade.phi;
      const double spiral = passive_log_spiral(blade.phi, blade.delta);
      EXPECT_GT(spiral, passive_lancellotta(blade.phi, blade.delta)) << phi << " " << share;
      EXPECT_LT(spiral, 1.002 * reece_wedge(blade).horizontal) << phi << " " << share;
    }
}

TEST(RoughPassive, OfASmoothBladeMatchesRankineWithCohesionAndAdhesion) {
  BladeCase blade;
  blade.phi = radians(35), blade.rake = kPi / 2;
  blade.depth = 0.3, blade.width = 2, blade.unit_weight = 16000, blade.cohesion = 2000;
  const double rankine = 2 * rankine_passive_force(blade.phi, 2000, 16000, 0.3);
  EXPECT_NEAR(rough_passive(blade).low / rankine, 1, 1e-6);
  EXPECT_NEAR(rough_passive(blade).high / rankine, 1, 2e-3);
  EXPECT_NEAR(rough_passive(blade).vertical, 0, 1e-3);
  blade.adhesion = 1000, blade.delta = radians(20);
  const PassiveBand rough = rough_passive(blade);
  EXPECT_GT(rough.high, rough.low);
  // Lift: friction on all pressure, and adhesion.
  EXPECT_NEAR(rough.vertical, rough.low * std::tan(radians(20)) + 1000 * 0.3 * 2, 1);
}

TEST(MatsuokaNakai, ConvertsAPlaneStrainAngleToATriaxialAngle) {
  EXPECT_NEAR(degrees(matsuoka_nakai_triaxial(radians(35))), 31.2, 0.05);
  // The two stress states lie on one surface: I1 I2 / I3 of both.
  const double phi = radians(27), s = std::sin(phi), t = std::sin(matsuoka_nakai_triaxial(phi));
  const auto kappa = [](double a, double b, double c) {
    return (a + b + c) * (a * b + b * c + c * a) / (a * b * c);
  };
  EXPECT_NEAR(kappa(1 + t, 1 - t, 1 - t), kappa(1 + s, 1, 1 - s), 1e-9);
  EXPECT_NEAR(kappa(1 + t, 1 + t, 1 - t), kappa(1 + s, 1, 1 - s), 1e-9);
  EXPECT_EQ(matsuoka_nakai_triaxial(0), 0);
}

}  // namespace
}  // namespace navvy::lab
