// SPDX-License-Identifier: Apache-2.0
// Active soil under wheels becomes ground that supports them [docs/exchange.md, support areas].
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/saved_state.h"
#include "soil/exchange/exchange_index.h"
#include "soil/exchange/exchange_site.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {
namespace {

// Of the wheel, of the layer [m].
constexpr double kRadius = 0.5, kDepth = 0.2;

/// A wheel that rolls along x over column (24, 20), its lowest point at this height [m].
SupportArea wheel_at(const Site& site, double height) {
  SupportArea wheel;
  wheel.p_W =
      Vec3(site.ground.origin().x() + 2.45, site.ground.origin().y() + 2.05, height + kRadius);
  wheel.radius = kRadius;
  wheel.half_width = 0.15;
  return wheel;
}

/// Loose sand on columns at height 0, two cells deep, everywhere but at the edges; no particle of
/// it moves.
std::vector<Particle> layer(const Site& site, double jitter = 0.2) {
  return fill(
      site, {4, 4, 50}, {44, 36, 52}, 1.1f, [](double, double, double) { return true; }, jitter);
}

Exchange::Result check(Site& site, const std::vector<SupportArea>& support_areas,
                       const std::vector<ToolRegion>& tools = {}) {
  Exchange::Result result =
      site.exchange.check(site.particles, tools, site.time, site.step, {support_areas, 0.05});
  site.time += site.step;
  std::vector<Particle> stay;
  for (std::size_t i = 0; i < site.particles.size(); ++i)
    if (result.removed[i] == 0) stay.push_back(site.particles[i]);
  for (Particle& p : result.born) {
    p.id = site.next_id++;
    stay.push_back(p);
  }
  site.particles = stay;
  return result;
}

double mass_over(const Site& site, int ix, int iy) {
  double sum = 0;
  for (const Particle& p : site.particles)
    if (PlanGrid{}.column_of(p) == std::pair{ix, iy}) sum += kilograms(p.mass);
  return sum;
}

TEST(ExchangeSupportArea, DepositsTheSoilUnderAWheelLevelAndLeavesTheRestActive) {
  Site site({sand()});
  site.add(layer(site));
  const std::size_t before = site.particles.size();
  const Exchange::Result result = check(site, {wheel_at(site, kDepth)});
  EXPECT_EQ(site.mass_errors(), site.closed());
  // The rim comes within a quarter of a cell of the layer over a length of 2 sqrt(2 r 0.025) = 0.32
  // m; with the column around and the wheel's width that are five or six columns along and five
  // across.
  EXPECT_GE(result.support_columns, 5 * 5);
  EXPECT_LE(result.support_columns, 7 * 6);
  EXPECT_LT(site.particles.size(), before);
  double most = 0;
  for (int ix = 23; ix <= 25; ++ix)
    for (int iy = 19; iy <= 21; ++iy) {
      EXPECT_EQ(mass_over(site, ix, iy), 0);
      most = std::max(most, std::abs(site.ground.height(ix, iy) - kDepth));
    }
  // Counted by column, jittered particles would scatter by centimetres; smoothed by position they
  // form a level surface. The remainder is the share of particles that the pool's edge cuts: one in
  // forty.
  EXPECT_LT(most, 0.008);
  EXPECT_NEAR(site.ground.height(24, 30), 0, 1e-9);
  EXPECT_NEAR(site.ground.specific_volume(24, 20), 1.1, 1e-3);
}

TEST(ExchangeSupportArea, LeavesAloneWhatAWheelDoesNotComeTo) {
  Site site({sand()});
  site.add(layer(site));
  EXPECT_EQ(check(site, {wheel_at(site, kDepth + 0.2)}).support_columns, 0);
  // It falls fast enough to arrive before the next check.
  SupportArea falls = wheel_at(site, kDepth + 0.2);
  falls.v_W.z() = -4;
  EXPECT_GT(check(site, {falls}).support_columns, 20);
}

TEST(ExchangeSupportArea, IsReadyWhereAWheelRollsUntilTheNextCheck) {
  Site stands({sand()}), rolls({sand()});
  for (Site* site : {&stands, &rolls}) site->add(layer(*site));
  SupportArea wheel = wheel_at(stands, kDepth);
  check(stands, {wheel});
  wheel.v_W.x() = 4;
  wheel.ready = 0.05;
  check(rolls, {wheel});
  // 4 m/s for 0.1 s.
  EXPECT_EQ(stands.ground.height(29, 20), 0);
  EXPECT_NEAR(rolls.ground.height(29, 20), kDepth, 0.01);
  EXPECT_NEAR(rolls.ground.height(21, 20), stands.ground.height(21, 20), 0.01);
}

TEST(ExchangeSupportArea, TakesNothingThatIsInTheAirInABucketOrTouched) {
  const auto in_column = [](const Particle& p) {
    return PlanGrid{}.column_of(p) == std::pair{24, 20};
  };
  enum { kInTheAir, kInABucket, kTouched, kKinds };
  for (int kind = 0; kind < kKinds; ++kind) {
    Site site({sand()});
    site.add(layer(site));
    std::vector<ToolRegion> tools;
    for (Particle& p : site.particles) {
      if (!in_column(p)) continue;
      // 0.65 m over the ground, at the axle.
      if (kind == kInTheAir) p.x[2] += 2.5f, p.block[2] += 1;
      if (kind == kTouched) p.side = 1;
    }
    if (kind == kInABucket) {
      // A cell over the ground and full.
      tools.emplace_back();
      tools[0].min = Vec3(site.ground.origin().x() + 2.41, site.ground.origin().y() + 2.01, 0.1);
      tools[0].max = tools[0].min + Vec3(0.08, 0.08, 0.2);
      std::erase_if(site.particles,
                    [&](const Particle& p) { return in_column(p) && height_in_cells(p) < 51; });
      site.inserted = {0};
      for (const Particle& p : site.particles) site.inserted[0] += p.mass;
    }
    const double before = mass_over(site, 24, 20);
    EXPECT_GT(before, 0);
    check(site, {wheel_at(site, kDepth)}, tools);
    EXPECT_EQ(mass_over(site, 24, 20), before) << "kind " << kind;
    EXPECT_EQ(mass_over(site, 26, 20), 0) << "kind " << kind;
    EXPECT_EQ(site.mass_errors(), site.closed());
  }
}

TEST(ExchangeSupportArea, DoesNotLiftAWheelByWhatStandsInIt) {
  Site site({sand()});
  site.add(layer(site));
  // The wheel stands half as deep in the layer as that is high, and its load flattens it by 20 mm.
  SupportArea wheel = wheel_at(site, 0.5 * kDepth);
  wheel.flattening = 0.02;
  check(site, {wheel});
  // Up to a particle's share of a column, 12.5 mm.
  EXPECT_NEAR(site.ground.height(24, 20), 0.5 * kDepth + wheel.flattening, 0.0125);
  EXPECT_GT(mass_over(site, 24, 20), 0);
  EXPECT_EQ(site.mass_errors(), site.closed());
  // Nor gradually while it moves.
  for (int n = 0; n < 40; ++n) {
    for (Particle& p : site.particles) p.v[2] = 0.1F;
    check(site, {wheel});
  }
  EXPECT_LT(site.ground.height(24, 20), 0.5 * kDepth + wheel.flattening + 0.0125);
}

TEST(ExchangeSupportArea, SoilUnderAWheelActivatesOnlyWhereAToolTouchesIt) {
  for (const bool wheel : {false, true})
    for (const bool touches : {false, true}) {
      Site site({sand()});
      ToolRegion tool;
      // Beside the wheel's columns, or over them; its zone of a depth to all sides covers them in
      // both cases.
      tool.min = Vec3(site.ground.origin().x() + 2.3,
                      site.ground.origin().y() + (touches ? 2.0 : 2.3), -0.3);
      tool.max = tool.min + Vec3(0.3, 0.2, 1);
      std::vector<SupportArea> support_areas;
      if (wheel) support_areas.push_back(wheel_at(site, 0));
      const Exchange::Result result = check(site, support_areas, {tool});
      EXPECT_GT(result.activated_columns, 10);
      EXPECT_EQ(site.ground.height(24, 20) < -0.1, touches || !wheel) << wheel << touches;
      EXPECT_EQ(site.mass_errors(), site.closed());
    }
}

TEST(ExchangeSupportArea, ABankThatIsTooSteepStaysUnderAWheel) {
  for (const bool wheel : {false, true}) {
    Site site({sand()});
    // A cut 0.5 m deep along the wheel, with active soil at its foot.
    std::vector<heightfield::SoilLayer> taken;
    for (int iy = 22; iy < 36; ++iy)
      for (int ix = 4; ix < 44; ++ix) site.ground.take_above(ix, iy, -0.5, taken);
    site.add(
        fill(site, {20, 24, 45}, {28, 28, 46}, 1.1f, [](double, double, double) { return true; }));
    std::vector<SupportArea> support_areas;
    if (wheel) support_areas.push_back(wheel_at(site, 0));
    EXPECT_GT(check(site, support_areas).activated_columns, 10);
    EXPECT_EQ(site.ground.height(24, 21) < -0.1, !wheel);
    EXPECT_LT(site.ground.height(15, 21), -0.1) << "away from the wheel the soil is activated";
  }
}

TEST(ExchangeSupportArea, ActivationAndSupportDoNotAlternate) {
  Site site({sand()});
  site.add(layer(site));
  // All active soil moves fast enough to activate its neighbours, while the wheel stands.
  for (int n = 0; n < 40; ++n) {
    for (Particle& p : site.particles) p.v[0] = 0.2F;
    const Exchange::Result result = check(site, {wheel_at(site, kDepth)});
    if (n == 0) continue;
    EXPECT_EQ(result.support_columns, 0) << "check " << n;
    EXPECT_NEAR(site.ground.height(24, 20), kDepth, 0.01);
  }
  EXPECT_EQ(site.mass_errors(), site.closed());
}

TEST(ExchangeSupportArea, TheOrderOfParticlesDoesNotMatterAndTwoSoilsKeepTheirMass) {
  Site a({sand(), loam()}), b({sand(), loam()});
  for (Site* site : {&a, &b}) {
    site->add(fill(
        *site, {4, 4, 50}, {44, 36, 51}, 1.1f, [](double, double, double) { return true; }, 0.2));
    site->add(fill(
        *site, {4, 4, 51}, {44, 36, 52}, 1.2f, [](double, double, double) { return true; }, 0.2,
        1));
  }
  Random random(3);
  for (std::size_t i = b.particles.size(); i > 1; --i)
    std::swap(b.particles[i - 1],
              b.particles[static_cast<std::size_t>(random.uniform(0, static_cast<double>(i)))]);
  for (int n = 0; n < 5; ++n) {
    SupportArea wheel = wheel_at(a, kDepth);
    wheel.p_W.x() += 0.07 * n;
    SupportArea other = wheel;
    other.p_W.y() += 0.4;
    check(a, {wheel, other});
    check(b, {wheel, other});
    ASSERT_EQ(hash_of(a.ground).hex(), hash_of(b.ground).hex());
    ASSERT_EQ(a.particles.size(), b.particles.size());
    ASSERT_EQ(a.mass_errors(), a.closed());
  }
  // Loam lies on sand, as before.
  EXPECT_EQ(a.ground.surface_soil(24, 20), 1);
  EXPECT_EQ(a.ground.layers(24, 20).size(), 3u);
}

TEST(ExchangeSupportArea, ATrackIsOneRunBetweenItsRollers) {
  Site site({sand()});
  site.add(layer(site));
  SupportArea track = wheel_at(site, kDepth);
  track.radius = 0.15;
  track.half_run = 1.2;
  track.p_W.z() = kDepth + track.radius;
  check(site, {track});
  for (int ix = 13; ix <= 36; ++ix) EXPECT_NEAR(site.ground.height(ix, 20), kDepth, 0.01) << ix;
  EXPECT_NEAR(site.ground.height(40, 20), 0, 1e-9);
  EXPECT_EQ(site.mass_errors(), site.closed());
}

}  // namespace
}  // namespace navvy::soil
