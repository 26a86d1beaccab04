// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"
#include "core/saved_state.h"
#include "flip_bytes.h"
#include "soil/exchange/exchange_site.h"

namespace navvy::soil {
namespace {

std::string digest(const Site& site) {
  StateHash hash = hash_of(site.ground);
  add_to_hash(hash, site.exchange);
  return hash.hex();
}

// A heap at rest, a cliff, moving soil beside a pit and a tool that drags through all of it.
void set_scene(Site& site) {
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = 0; iy < 16; ++iy)
    for (int ix = 0; ix < 12; ++ix) site.ground.take_above(ix, iy, -1, taken);
  site.add(fill(
      site, {28, 24, 50}, {36, 32, 54}, 1.13f,
      [](double x, double y, double z) { return std::hypot(x - 32, y - 28) < 4 - 1.5 * (z - 50); },
      0.2));
  site.activate({20, 8, 28, 14}, -0.4);
  for (std::size_t i = 0; i < site.particles.size(); ++i)
    if (i % 37 == 0) site.particles[i].v[0] = 0.3f;
}

ToolRegion tool_at(const Site& site, double time) {
  ToolRegion tool;
  tool.min =
      Vec3(site.ground.origin().x() + 1.5 + 0.5 * time, site.ground.origin().y() + 2.4, -0.25);
  tool.max = tool.min + Vec3(0.3, 0.6, 0.6);
  tool.velocity = Vec3(0.5, 0, 0);
  return tool;
}

TEST(ExchangeState, MassBalanceHoldsThroughRandomWork) {
  Site site({sand(), loam()}, 48, 40, {{"loam", 0.4}, {"sand", 9}});
  set_scene(site);
  const std::vector<std::int64_t> before = site.mass_errors();
  Random random(11);
  int activated = 0, deposited = 0, slumped = 0;
  for (int n = 0; n < 120; ++n) {
    // Soil moves as if a solver ran, then rests again.
    for (Particle& p : site.particles) {
      const bool moves = n % 40 < 8 && random.uniform() < 0.05;
      p.v[0] = moves ? static_cast<float>(random.uniform(-0.5, 0.5)) : 0.0f;
    }
    const Exchange::Result result =
        site.check(n < 60 ? std::vector{tool_at(site, site.time)} : std::vector<ToolRegion>{});
    ASSERT_EQ(site.mass_errors(), before) << "check " << n;
    activated += result.activated_columns;
    deposited += result.deposited_blocks;
    slumped += result.slumped_columns;
  }
  EXPECT_GT(activated, 100);
  EXPECT_GT(deposited, 10);
  EXPECT_GT(slumped, 10);
}

TEST(ExchangeState, TheOrderOfParticlesAndToolsDoesNotMatter) {
  Site a({sand()}), b({sand()});
  set_scene(a);
  set_scene(b);
  Random random(5);
  for (int n = 0; n < 50; ++n) {
    ToolRegion far;
    far.min = Vec3(0.5, 5, -0.1);
    far.max = far.min + Vec3(0.2, 0.2, 0.5);
    const ToolRegion tool = tool_at(a, a.time);
    const Exchange::Result one = a.check({tool, far});
    for (std::size_t i = b.particles.size(); i > 1; --i)
      std::swap(b.particles[i - 1],
                b.particles[static_cast<std::size_t>(random.uniform(0, static_cast<double>(i)))]);
    const Exchange::Result two = b.check({far, tool});
    ASSERT_EQ(one.born.size(), two.born.size());
    for (std::size_t i = 0; i < one.born.size(); ++i) ASSERT_EQ(one.born[i].mass, two.born[i].mass);
    ASSERT_EQ(digest(a), digest(b)) << "check " << n;
  }
  EXPECT_EQ(a.particles.size(), b.particles.size());
}

TEST(ExchangeState, ASavedExchangeGoesOnAsIfNothingHadHappened) {
  Site a({sand()}), b({sand()});
  set_scene(a);
  for (int n = 0; n < 15; ++n) a.check({tool_at(a, a.time)});
  b.particles = a.particles;
  b.time = a.time;
  b.next_id = a.next_id;
  load_saved(saved(a.ground), b.ground);
  load_saved(saved(a.exchange), b.exchange);
  EXPECT_EQ(digest(a), digest(b));
  for (int n = 0; n < 40; ++n) {
    const auto tools = std::vector{tool_at(a, a.time)};
    a.check(tools);
    b.check(tools);
    ASSERT_EQ(digest(a), digest(b)) << "check " << n;
  }
}

TEST(ExchangeState, TheHashSeesRestingTimesAndSlidingColumns) {
  Site site({sand()});
  set_scene(site);
  const std::string before = hash_of(site.exchange).hex();
  site.check();
  EXPECT_NE(hash_of(site.exchange).hex(), before);
}

TEST(ExchangeState, EverySavedByteIsHashedOrRefused) {
  Site site({sand()}), other({sand()});
  set_scene(site);
  for (int n = 0; n < 15; ++n) site.check({tool_at(site, site.time)});
  load_saved(saved(site.ground), other.ground);
  EXPECT_EQ(test::flip_every_byte(site.exchange, other.exchange), "");
}

}  // namespace
}  // namespace navvy::soil
