// SPDX-License-Identifier: Apache-2.0
#include "heightfield/make_ground.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "heightfield/procedural.h"
#include "heightfield/settle.h"

namespace navvy::heightfield {
namespace {

using Kind = scene::GroundFeature::Kind;

scene::Scene world_with(const std::vector<scene::GroundFeature>& features,
                        Vec2 size = Vec2(12, 8)) {
  scene::Scene world;
  world.soils.resize(1);
  world.soils[0].name = "loam";
  world.soils[0].friction_angle = radians(30);
  world.ground.layers = {{"loam", 1}};
  world.ground.size = size;
  world.ground.features = features;
  return world;
}

scene::GroundFeature feature(Kind kind, double length, double width, double height, double angle,
                             double yaw = 0, Vec2 center = Vec2::Zero()) {
  scene::GroundFeature f;
  f.kind = kind;
  f.length = length;
  f.width = width;
  f.height = height;
  f.angle = angle;
  f.yaw = yaw;
  f.center = center;
  return f;
}

// Heights are counted in mass units of 4e-9 m here.
constexpr double kHeightQuantum = 1e-8;

TEST(Site, IsRoundedUpToBlocksAndCentredOnTheOrigin) {
  scene::Scene world = world_with({}, Vec2(10.05, 7.2));
  world.ground.surface = 2.5;
  const Ground ground = make_ground(world);
  EXPECT_EQ(ground.nx(), 104);
  EXPECT_EQ(ground.ny(), 72);
  EXPECT_NEAR(ground.origin().x(), -5.2, 1e-12);
  EXPECT_NEAR(ground.origin().y(), -3.6, 1e-12);
  EXPECT_NEAR(ground.sample(0, 0), 2.5, kHeightQuantum);
  EXPECT_NEAR(ground.datum(), 2.5 - 4, 1e-12);
  world.ground.has_origin = true;
  world.ground.origin = Vec2(100, 200);
  EXPECT_EQ(make_ground(world).origin(), Vec2(100, 200));
  EXPECT_EQ(site_columns(20, 0.1), 200);
  EXPECT_EQ(site_columns(0.3, 0.1), 4);
}

TEST(Site, SlopeRisesAlongItsYaw) {
  const Ground ground =
      make_ground(world_with({feature(Kind::kSlope, 1, 1, 1, radians(10), radians(90))}));
  EXPECT_NEAR(ground.sample(2, 3) - ground.sample(2, -3), 6 * std::tan(radians(10)), 1e-7);
  EXPECT_NEAR(ground.sample(4, 1), ground.sample(-4, 1), 1e-7);
  EXPECT_NEAR(ground.sample(0, 0), 0, 1e-7);
  // Bedrock is the given depth below the lowest column.
  EXPECT_NEAR(ground.datum(), ground.height(0, 0) - 4, 1e-7);
}

TEST(Site, TrenchRunsAlongItsYawWithLeaningSides) {
  const Ground ground =
      make_ground(world_with({feature(Kind::kTrench, 4, 1, 0.8, radians(45), radians(90))}));
  EXPECT_NEAR(ground.sample(0, 1.9), -0.8, kHeightQuantum);  // floor: 4 m along y
  EXPECT_NEAR(ground.sample(0.45, 0), -0.8, kHeightQuantum);
  EXPECT_NEAR(ground.sample(0.95, 0.05), -0.8 + 0.45, 1e-7);  // half way up the side, 45 deg
  EXPECT_NEAR(ground.sample(1.95, 0), 0, kHeightQuantum);
  EXPECT_NEAR(ground.datum(), -4.8, 1e-12);
}

TEST(Site, StockpileHasTheFrictionAngleOfItsSoil) {
  const Ground ground =
      make_ground(world_with({feature(Kind::kStockpile, 1, 1, 1.2, 0, 0, Vec2(1, -1))}));
  EXPECT_NEAR(ground.sample(2.05, -0.95), 1.2 - std::hypot(1.05, 0.05) * std::tan(radians(30)),
              1e-7);
  EXPECT_NEAR(ground.sample(-4, -1), 0, kHeightQuantum);
}

TEST(Site, BankRisesToTheLeftOfItsLine) {
  const Ground ground =
      make_ground(world_with({feature(Kind::kBank, 1, 1, 2, radians(60), 0, Vec2(0, 1))}));
  EXPECT_NEAR(ground.sample(0, 0.9), 0, kHeightQuantum);
  EXPECT_NEAR(ground.sample(-5, 3), 2, kHeightQuantum);
  EXPECT_NEAR(ground.sample(0.05, 1.55), 0.55 * std::tan(radians(60)), 1e-7);
}

TEST(Site, BlockStandsFree) {
  const Ground ground = make_ground(world_with({feature(Kind::kBlock, 3, 1, 1, 0)}));
  EXPECT_NEAR(ground.sample(1.4, 0.4), 1, kHeightQuantum);
  EXPECT_NEAR(ground.sample(1.6, 0), 0, kHeightQuantum);
  EXPECT_NEAR(ground.sample(0, 0.6), 0, kHeightQuantum);
}

TEST(Site, HillsAreSeededBoundedAndSmooth) {
  scene::GroundFeature f = feature(Kind::kHills, 6, 1, 2, 0);
  const Ground a = make_ground(world_with({f}, Vec2(40, 30))),
               b = make_ground(world_with({f}, Vec2(40, 30)));
  f.seed = 2;
  const Ground c = make_ground(world_with({f}, Vec2(40, 30)));
  double low = 1e9, high = -1e9, steepest = 0, differs = 0;
  for (int iy = 0; iy < a.ny(); ++iy)
    for (int ix = 0; ix < a.nx(); ++ix) {
      const double h = a.height(ix, iy);
      ASSERT_EQ(h, b.height(ix, iy));
      low = std::min(low, h);
      high = std::max(high, h);
      steepest = std::max(steepest, std::abs(a.height(ix + 1, iy) - h) / 0.1);
      differs = std::max(differs, std::abs(h - c.height(ix, iy)));
    }
  EXPECT_GE(low, -1);
  EXPECT_LE(high, 1);
  EXPECT_GT(high - low, 0.8);  // it uses a good part of its height
  EXPECT_GT(differs, 0.2);     // another seed is another landscape
  // The quintic fade is steepest at 15/8 per lattice step: 0.75 x 2 m x 15/8 / 3 m plus the second
  // octave (twice as fine, a third as high).
  EXPECT_LT(steepest, 2.2);
}

TEST(Site, SettlesSlopesAboveReposeOnceAndKeepsVolume) {
  scene::Scene world = world_with({feature(Kind::kBank, 1, 1, 1.5, radians(75))});
  const Ground held = make_ground(world);
  world.ground.steep = scene::SteepGround::kSettle;
  const Ground settled = make_ground(world), again = make_ground(world);
  double before = 0, after = 0, steepest = 0;
  for (int iy = 0; iy < held.ny(); ++iy)
    for (int ix = 0; ix < held.nx(); ++ix) {
      before += held.height(ix, iy);
      after += settled.height(ix, iy);
      ASSERT_EQ(settled.height(ix, iy), again.height(ix, iy));
      steepest =
          std::max(steepest, std::abs(settled.height(ix, iy + 1) - settled.height(ix, iy)) / 0.1);
    }
  EXPECT_NEAR(after / before, 1, 1e-8);
  // The friction angle: no soil slides when the run begins.
  EXPECT_LT(degrees(std::atan(steepest)), 30);
  EXPECT_GT(degrees(std::atan(steepest)), 27);  // and not flatter than it has to be
  world.ground.size = Vec2(1000, 1000);
  EXPECT_THROW(make_ground(world), InputError);
}

TEST(Site, RefusesAbsurdSizes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec2& size : {Vec2(0, 5), Vec2(nan, 5), Vec2(5, -1), Vec2(1e300, 5)})
    EXPECT_THROW(make_ground(world_with({}, size)), InputError);
  scene::Scene world = world_with({});
  world.solver.cell = 0;
  EXPECT_THROW(make_ground(world), InputError);
  world = world_with({});
  world.ground.depth = -1;
  EXPECT_THROW(make_ground(world), InputError);
  world = world_with({});
  world.ground.surface = nan;
  EXPECT_THROW(make_ground(world), InputError);
}

}  // namespace
}  // namespace navvy::heightfield
