// SPDX-License-Identifier: Apache-2.0
// Bearing capacity, and soil that flows instead of being compacted: limits and published values.
#include "terramechanics/bearing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "terramechanics/plate.h"

namespace navvy::terramechanics {
namespace {

scene::Soil sand() {
  scene::Soil soil;
  soil.bank_density = 1600;
  soil.swell = 1.13;
  soil.friction_angle = radians(31);
  soil.cohesion = soil.residual_cohesion = 0;
  soil.bekker_kc = 990, soil.bekker_kphi = 1528430, soil.bekker_n = 1.1;
  return soil;
}

TEST(Bearing, FactorsMatchTerzaghi) {
  // Nc, Nq, Ngamma as tabulated by phi: [Terzaghi 1943].
  struct Row {
    double phi, c, q, gamma;
  };
  for (const Row& row : {Row{0, 5.71, 1.0, 0}, Row{10, 9.61, 2.69, 1.2}, Row{20, 17.69, 7.44, 5.0},
                         Row{30, 37.16, 22.46, 19.7}, Row{40, 95.66, 81.27, 100.4}}) {
    const BearingFactors n = BearingFactors::of(std::tan(radians(row.phi)));
    EXPECT_NEAR(n.c, row.c, 0.005 * row.c) << row.phi;
    EXPECT_NEAR(n.q, row.q, 0.005 * row.q) << row.phi;
    // The closed form is a fit.
    EXPECT_NEAR(n.gamma, row.gamma, 0.21 * row.gamma) << row.phi;
  }
}

TEST(Bearing, OfFrictionlessClayFollowsFromCohesionAndSurcharge) {
  scene::Soil clay;
  clay.friction_angle = 0;
  clay.cohesion = 12e3, clay.residual_cohesion = 4e3, clay.loose_cohesion = 3e3;
  const double weight = clay.bank_density * kGravity;
  EXPECT_NEAR(bearing_capacity({&clay, 1}, 0.5, 0.2), 5.712 * 12e3 + 0.2 * weight, 20);
  // Loose: remoulded, two thirds of it.
  EXPECT_NEAR(bearing_capacity({&clay, clay.swell}, 0.5, 0), 5.712 * 2e3, 2);
  EXPECT_EQ(bearing_capacity({}, 0.5, 0.2), 0);
}

TEST(Bearing, SoilFlowsOnlyBeyondItsBearingCapacity) {
  const scene::Soil soil = sand();
  const SoilState bank{&soil, 1}, loose{&soil, soil.swell};
  const double b = 0.28;
  double least = 0;
  while (plate_pressure(soil, least, b) < bearing_capacity(bank, b, least)) least += 1e-4;
  EXPECT_EQ(pushed_depth(bank, b, 0, 0.99 * least), 0);
  EXPECT_GT(pushed_depth(bank, b, least, least + 0.02), 0.005);
  // 98 kPa at 0.12 m compact 0.082 m of 0.12: (98 / 1532)^(1 / 1.1) by hand.
  EXPECT_NEAR(bearing_capacity(bank, b, 0.12), 98e3, 2e3);
  EXPECT_NEAR(pushed_depth(bank, b, 0, 0.12), 0.12 - 0.082, 0.002);
  // Never more than it sinks; more in loose soil; none at rest.
  for (double z = 0.01; z < 0.5; z += 0.03) {
    EXPECT_LE(pushed_depth(bank, b, 0, z), pushed_depth(loose, b, 0, z)) << z;
    EXPECT_LE(pushed_depth(loose, b, 0, z), z) << z;
    EXPECT_EQ(pushed_depth(bank, b, z, z), 0);
  }
  // In steps, the same as at once.
  double sum = 0;
  for (int i = 0; i < 40; ++i) sum += pushed_depth(bank, b, 0.005 * i, 0.005 * (i + 1));
  EXPECT_NEAR(pushed_depth(bank, b, 0, 0.2), sum, 1e-12);
  EXPECT_EQ(pushed_depth({}, b, 0, 1), 0);
}

TEST(Bearing, IsExceededInMud) {
  scene::Soil mud;
  mud.friction_angle = 0;
  mud.cohesion = mud.residual_cohesion = 10;
  EXPECT_GT(pushed_depth({&mud, 1}, 0.3, 0.05, 0.1), 0.99 * 0.05);
}

TEST(Bulldozing, MatchesBekkersPassiveResistance) {
  // Without friction: R = b (2/3 c z 5.712 + gamma z^2 (4 x 2 + 1) / 2).
  scene::Soil clay;
  clay.friction_angle = 0;
  clay.cohesion = clay.residual_cohesion = 9e3;
  const double weight = clay.bank_density * kGravity;
  EXPECT_NEAR(passive_resistance({&clay, 1}, 0.3, 0.1),
              0.3 * (6e3 * 0.1 * 5.712 + 0.5 * weight * 0.01 * 9), 0.5);
  // tan phi' = tan 20 deg: Nc 17.69, Ngamma 4.41 by the closed form, cos^2 0.883.
  scene::Soil loam;
  loam.friction_angle = std::atan(1.5 * std::tan(radians(20)));
  loam.cohesion = loam.residual_cohesion = 6e3;
  const double k_c = (17.69 - 0.364) * 0.883, k_gamma = (2 * 4.41 / 0.364 + 1) * 0.883;
  const double expected =
      0.28 * (4e3 * 0.05 * k_c + 0.5 * loam.bank_density * kGravity * 0.0025 * k_gamma);
  EXPECT_NEAR(passive_resistance({&loam, 1}, 0.28, 0.05), expected, 0.005 * expected);
  EXPECT_EQ(passive_resistance({&loam, 1}, 0.28, 0), 0);
  EXPECT_EQ(passive_resistance({}, 0.28, 0.1), 0);
}

TEST(Bulldozing, IsMobilisedByTheTravelOfTheRim) {
  const scene::Soil soil = sand();
  const SoilState bank{&soil, 1};
  const double r = 0.5, z = 0.1, full = passive_resistance(bank, 0.3, z);
  const auto share = [&](double advance) { return bulldozing(bank, 0.3, r, z, advance) / full; };
  // Rolling without slip, in cohesionless soil: the integral of 2 x (1 - exp(-j / K)) over x = d /
  // z.
  double expected = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = (i + 0.5) / 1000, theta = std::acos(1 - z * (1 - x) / r);
    expected += 2 * x * (1 - std::exp(-r * (theta - std::sin(theta)) / soil.janosi_k)) / 1000;
  }
  EXPECT_NEAR(share(1), expected, 0.01 * expected);
  EXPECT_LT(share(1), 1 - std::exp(-0.02175 / soil.janosi_k));  // share of the soil at the surface
  EXPECT_EQ(share(0.8), 0);  // a slipping wheel carries soil back
  EXPECT_EQ(share(0), 0);
  EXPECT_GT(share(1.25), share(1));
  EXPECT_EQ(share(INFINITY), 1);     // locked
  EXPECT_EQ(share(-1), 1);           // turns back
  EXPECT_NEAR(share(1e4), 1, 0.01);  // nearly locked
}

}  // namespace
}  // namespace navvy::terramechanics
