// SPDX-License-Identifier: Apache-2.0
// Bearing capacity, and soil that flows instead of being compacted: limits and published numbers.
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

TEST(Bearing, FactorsAreTerzaghis) {
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

TEST(Bearing, OfClayWithoutFrictionIsItsCohesionAndWhatLiesBeside) {
  scene::Soil clay;
  clay.friction_angle = 0;
  clay.cohesion = 12e3, clay.residual_cohesion = 3e3;
  const double weight = clay.bank_density * kGravity;
  EXPECT_NEAR(bearing_capacity({&clay, 1}, 0.5, 0.2), 5.712 * 12e3 + 0.2 * weight, 20);
  // Loose: remoulded, two thirds of it.
  EXPECT_NEAR(bearing_capacity({&clay, clay.swell}, 0.5, 0), 5.712 * 2e3, 2);
  EXPECT_EQ(bearing_capacity({}, 0.5, 0.2), 0);
}

TEST(Bearing, SoilFlowsOnlyBeyondWhatItBears) {
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
  // Never more than it sinks; more where it lies loose; nothing while it stands.
  for (double z = 0.01; z < 0.5; z += 0.03) {
    EXPECT_LE(pushed_depth(bank, b, 0, z), pushed_depth(loose, b, 0, z)) << z;
    EXPECT_LE(pushed_depth(loose, b, 0, z), z) << z;
    EXPECT_EQ(pushed_depth(bank, b, z, z), 0);
  }
  // In steps as at once.
  double sum = 0;
  for (int i = 0; i < 40; ++i) sum += pushed_depth(bank, b, 0.005 * i, 0.005 * (i + 1));
  EXPECT_NEAR(pushed_depth(bank, b, 0, 0.2), sum, 1e-12);
  EXPECT_EQ(pushed_depth({}, b, 0, 1), 0);
}

TEST(Bearing, MudFlows) {
  scene::Soil mud;
  mud.friction_angle = 0;
  mud.cohesion = mud.residual_cohesion = 10;
  EXPECT_GT(pushed_depth({&mud, 1}, 0.3, 0.05, 0.1), 0.99 * 0.05);
}

}  // namespace
}  // namespace navvy::terramechanics
