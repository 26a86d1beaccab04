// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/log.h"
#include "core/random.h"
#include "soil/exchange/exchange_index.h"
#include "soil/exchange/exchange_site.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil {
namespace {

double stress_zz(const Site& site, const Particle& p) {
  const double bulk = law_constants(site.world.soils[p.soil], kCell).bulk;
  return static_cast<double>(p.s[2]) -
         bulk * std::max(0.0, 1.0 - static_cast<double>(p.j) / static_cast<double>(p.j0));
}

TEST(ExchangeActivation, KeepsTheMassOfEverySoilInRandomColumns) {
  Random random(3);
  Site site({sand(), loam()}, 40, 40, {{"loam", 0.33}, {"sand", 0.21}, {"loam", 9}},
            [](int ix, int iy) { return 0.03 * ix - 0.017 * iy; });
  for (int n = 0; n < 60; ++n) {
    const int ix = static_cast<int>(random.uniform(0, 39)),
              iy = static_cast<int>(random.uniform(0, 39));
    const double z = site.ground.height(ix, iy) + random.uniform(-1.2, 0.1);
    site.ground.put(
        ix, iy,
        {static_cast<std::uint16_t>(n % 2), static_cast<std::int64_t>(random.uniform(1, 3e7)),
         static_cast<float>(random.uniform(0.9, 1.2)), 1.0f});
    const std::vector<std::int64_t> before = site.ground.mass_change();
    std::vector<std::int64_t> after = before;
    const auto born = site.exchange.activate({ix - 1, iy, ix + 2, iy + 1}, z);
    after = site.ground.mass_change();
    for (const Particle& p : born) {
      EXPECT_GT(p.mass, 0);
      after[p.soil] += p.mass;
    }
    EXPECT_EQ(after, before);
  }
}

TEST(ExchangeActivation, PutsFlatGroundUnderTheStressOfItsWeight) {
  // 0.73 m: layers are not half cells.
  for (const scene::Soil& soil : {sand(), loam()}) {
    Site site({soil});
    site.add(site.exchange.activate({10, 10, 12, 12}, -0.73));
    ASSERT_EQ(site.particles.size(), 2u * 2u * 15u * 4u);
    const double weight = soil.bank_density * kGravity;
    double sum = 0, expected_sum = 0;
    for (const Particle& p : site.particles) {
      const double depth = -(site.ground.datum() + height_in_cells(p) * kCell);
      // A thousandth: stress and volume ratio are floats, and K (1 - j/j0) cancels.
      EXPECT_NEAR(stress_zz(site, p), -weight * depth, 1e-3 * weight);
      EXPECT_NEAR(p.s[0] + p.s[1] + p.s[2], 0, 1e-2);
      EXPECT_FLOAT_EQ(p.j0, 1);
      sum += stress_zz(site, p);
      expected_sum -= weight * depth;
      // At or inside the yield surface alpha p + k, with rounding.
      const LawConstants law = law_constants(soil, kCell);
      const double q = std::sqrt(0.5 * (p.s[0] * p.s[0] + p.s[1] * p.s[1] + p.s[2] * p.s[2]));
      const double pressure = p.s[2] - stress_zz(site, p);
      EXPECT_LE(q, law.alpha * pressure + law.k_loose + law.k_dense + law.k_bond + 5);
    }
    std::printf("[ VALUE    ] %s: sum sigma_z %.1f Pa, expected %.1f +-0.1 %%\n", soil.name.c_str(),
                sum, expected_sum);
    EXPECT_NEAR(sum, expected_sum, 1e-3 * std::abs(expected_sum));
  }
}

TEST(ExchangeActivation, CarriesTheWeightOfSoilOnTopButNotOfSoilInTheAir) {
  Site site({sand()});
  // Thickness of loose soil in its own state [m].
  const double extra = 0.5;
  for (const bool hangs : {false, true}) {
    const int z0 = 50 + (hangs ? 4 : 0);
    const auto load = fill(site, {10, 10, z0}, {11, 11, z0 + 5}, 1.13f,
                           [](double, double, double) { return true; });
    const auto born = site.exchange.activate({10, 10, 11, 11}, -0.5, load);
    const double weight = 1600 * kGravity * (0.25 + (hangs ? 0 : extra / 1.13));
    double sum = 0;
    for (const Particle& p : born) sum -= stress_zz(site, p) / static_cast<double>(born.size());
    // Masses of the load are rounded, stress is a float.
    EXPECT_NEAR(sum, weight, 2e-3 * weight);
    // Returned for the second round.
    for (const Particle& p : born) site.ground.put(10, 10, {0, p.mass, 1, 0});
  }
}

TEST(ExchangeActivation, CutsLayersSoThatAParticleIsOfOneSoilAndState) {
  Site site({sand(), loam()}, 20, 20, {{"loam", 0.13}, {"sand", 9}});
  site.ground.put(5, 5, {1, mass_units(3.0), 1.2f, 2.0f});
  const std::int64_t put = mass_units(3.0);
  const double top = site.ground.height(5, 5);
  site.add(site.exchange.activate({5, 5, 6, 6}, -0.4));
  double volume = 0, loose_mass = 0;
  for (const Particle& p : site.particles) {
    const double z = site.ground.datum() + height_in_cells(p) * kCell;
    EXPECT_EQ(p.soil, z > -0.13 ? 1 : 0) << z;
    EXPECT_GE(p.j0, 1.0f);
    EXPECT_LE(p.j0, 1.2f);
    volume += kilograms(p.mass) * p.j0 / site.world.soils[p.soil].bank_density;
    loose_mass += kilograms(p.mass) * p.shear / 2.0;
  }
  // Volume and plastic shear are preserved up to float rounding.
  EXPECT_NEAR(volume, (top + 0.4) * kCell * kCell, 1e-6 * volume);
  EXPECT_NEAR(loose_mass, kilograms(put), 1e-5);
}

TEST(ExchangeActivation, AToolActivatesTwoDigDepthsAheadOneAsideAndACellBelow) {
  Site site({sand()}, 60, 60);
  ToolRegion tool;  // 0.3 m deep, 1 m wide, moves along +x
  const Vec2 o = site.ground.origin();
  tool.min = Vec3(o.x() + 2.02, o.y() + 2.02, -0.3);
  tool.max = Vec3(o.x() + 2.12, o.y() + 2.98, 0.5);
  tool.velocity = Vec3(0.5, 0, 0);
  const Exchange::Result result = site.check({tool});
  EXPECT_GT(result.activated_columns, 0);
  heightfield::CellRect activated;
  for (int iy = 0; iy < 60; ++iy)
    for (int ix = 0; ix < 60; ++ix)
      if (site.ground.height(ix, iy) < -0.01) {
        activated.include({ix, iy, ix + 1, iy + 1});
        EXPECT_LE(site.ground.height(ix, iy), -0.4 + 1e-6);
        EXPECT_GE(site.ground.height(ix, iy), -0.5 - 1e-6);
      }
  // 2 d = 0.6 m ahead of 2.12 m, 1 d = 0.3 m to the other sides.
  EXPECT_EQ(activated.x1, 28);
  EXPECT_EQ(activated.x0, 17);
  EXPECT_EQ(activated.y0, 17);
  EXPECT_EQ(activated.y1, 33);
  EXPECT_EQ(site.mass_errors(), site.closed());
  // Nothing new happens while it stays.
  EXPECT_EQ(site.checks(0.4, {tool}).activated_columns, 0);
}

TEST(ExchangeActivation, MotionBesideRestingSoilActivatesItRingingAndElasticWavesDoNot) {
  struct Case {
    float speed, shear;  // [m/s], [-]
    int activated;
  };
  // The last one moves like soil in a stress wave: it has not failed.
  for (const Case& c : {Case{0.01F, 1, 0}, Case{0.2F, 1, 6 * 6}, Case{0.2F, 0.01F, 0}}) {
    Site site({sand()});
    site.activate({10, 10, 14, 14}, -0.3);
    for (Particle& p : site.particles) p.v[0] = c.speed, p.shear = c.shear;
    EXPECT_EQ(site.check().activated_columns, c.activated)
        << c.speed << " m/s, sheared by " << c.shear;
    EXPECT_EQ(site.mass_errors(), site.closed());
  }
}

TEST(ExchangeActivation, ShrinksFromTheFarthestWhenTheBudgetIsFull) {
  std::vector<std::string> lines;
  set_log_sink([&](LogLevel, const std::string& text) { lines.push_back(text); });
  scene::Scene world = Site::make_world({sand()});
  world.solver.max_particles = 1500;
  heightfield::Ground ground = make_ground(world, 60, 60, {{"sand", 9}});
  Exchange exchange(world, ground);
  ToolRegion tool;
  tool.min = Vec3(ground.origin().x() + 3, ground.origin().y() + 3, -0.3);
  tool.max = tool.min + Vec3(0.1, 0.1, 1);
  tool.velocity = Vec3(0.5, 0, 0);
  Exchange::Result result = exchange.check({}, std::vector{tool}, 0, kCheck);
  EXPECT_GT(result.activated_columns, 10);
  EXPECT_LE(result.born.size(), 1500u);
  const double under_tool = ground.height(30, 30);
  EXPECT_LT(under_tool, -0.39);
  EXPECT_NEAR(ground.height(36, 34), 0, 1e-9);
  // The warning is logged once.
  exchange.check(result.born, std::vector{tool}, kCheck, kCheck);
  set_log_sink({});
  EXPECT_EQ(lines.size(), 1u);
}

TEST(ExchangeActivation, RefusesCellsWhoseParticlesWouldBeTooHeavy) {
  scene::Scene world = Site::make_world({sand()});
  world.solver.cell = 1.5;
  heightfield::Ground ground = make_ground(world, 4, 4, {{"sand", 9}});
  EXPECT_THROW(Exchange(world, ground), InputError);
}

}  // namespace
}  // namespace navvy::soil
