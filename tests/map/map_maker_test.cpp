// SPDX-License-Identifier: Apache-2.0
#include "map/map_maker.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <ctime>
#include <set>

#include "core/error.h"
#include "core/random.h"
#include "heightfield/loose_soil.h"
#include "map/grounds.h"

namespace navvy::map {
namespace {

using heightfield::CellRect;
using heightfield::Ground;
using heightfield::TerrainView;
using testing::map_of;
using testing::setup;

Ground wavy() {
  heightfield::GroundSetup s = setup();
  s.surface = [](int ix, int iy) {
    return 0.3 * std::sin(0.11 * ix) + 0.2 * std::cos(0.07 * iy) + 0.01 * ix;
  };
  return Ground(s);
}

/// Makes a hole or a heap of up to 12 x 12 columns, possibly across the edge of the site.
CellRect edit(Ground& ground, Random& random) {
  const auto within = [&](int most) { return static_cast<int>(random.uniform() * most); };
  const int x0 = within(ground.nx()), y0 = within(ground.ny());
  const CellRect rect =
      CellRect{x0, y0, x0 + 1 + within(12), y0 + 1 + within(12)}.cut(ground.site_rect());
  const bool dig = random.uniform() < 0.5;
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      if (dig)
        ground.take_above(ix, iy, ground.height(ix, iy) - random.uniform(), taken);
      else
        ground.put(ix, iy, {0, mass_units(1 + 3 * random.uniform()), 1.2f, 0});
    }
  return rect;
}

/// Returns a view with loose soil on some columns, so that visible heights differ from those of
/// columns.
TerrainView seen(const Ground& ground, double time, Random& random) {
  std::vector<heightfield::LooseGrain> grains;
  for (int i = 0; i < 30; ++i) {
    const int ix = 20 + static_cast<int>(random.uniform() * 30),
              iy = 40 + static_cast<int>(random.uniform() * 30);
    grains.push_back({ix, iy, ground.height(ix, iy) + 0.02, 1e-4, 0, 1.25f, 0});
  }
  const TerrainView view = ground.view(time);
  return view.with(heightfield::LooseSoil(view, grains), heightfield::SurfaceKind::kMapped);
}

bool same_bits(const TerrainMap& a, const TerrainMap& b, MapLayer layer) {
  const std::vector<float> x = a.copy(layer), y = b.copy(layer);
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
}

TEST(MapMaker, UpdatesMatchAFullComputationBitForBit) {
  Random random(7);
  Ground ground = wavy();
  MapOptions options;
  options.target.assign(static_cast<std::size_t>(ground.nx()) * ground.ny(), -0.4f);
  for (int i = 0; i < 300; ++i) options.target[static_cast<std::size_t>(37 * i)] = kUnknown;
  MapMaker maker(options);
  maker.update(ground.view());
  int partial = 0;
  for (int round = 0; round < 60; ++round) {
    for (int i = 0; i < 1 + round % 5; ++i) edit(ground, random);
    const TerrainView view = seen(ground, round, random);
    std::int64_t area = 0;
    for (const CellRect& rect : maker.update(view)) area += rect.area();
    partial += area < ground.site_rect().area() ? 1 : 0;
    MapMaker whole(options);
    whole.update(view);
    for (const LayerInfo& each : layers())
      // This layer holds a history, which a full computation cannot know; the next test covers it.
      if (each.layer != MapLayer::kDisturbedAt)
        ASSERT_TRUE(same_bits(maker.map(), whole.map(), each.layer))
            << each.name << " in round " << round;
  }
  EXPECT_GT(partial, 50) << "the updates were full computations themselves";
}

TEST(MapMaker, StampsOnlyColumnsThatChanged) {
  Random random(3);
  Ground ground = wavy();
  MapMaker maker({});
  maker.update(ground.view());
  std::vector<float> expected(static_cast<std::size_t>(ground.nx()) * ground.ny(), kUnknown);
  TerrainMap before = maker.map();
  for (int round = 1; round <= 20; ++round) {
    edit(ground, random);
    maker.update(ground.view(0.25 * round));
    const TerrainMap now = maker.map();
    for (int iy = 0; iy < ground.ny(); ++iy)
      for (int ix = 0; ix < ground.nx(); ++ix) {
        bool differs = false;
        for (const MapLayer each : {MapLayer::kElevation, MapLayer::kSoil, MapLayer::kDensity})
          differs = differs || before.at(each, ix, iy) != now.at(each, ix, iy);
        float& stamp = expected[static_cast<std::size_t>(iy) * ground.nx() + ix];
        if (differs) stamp = 0.25f * static_cast<float>(round);
        const float disturbed_at = now.at(MapLayer::kDisturbedAt, ix, iy);
        ASSERT_TRUE(disturbed_at == stamp || (disturbed_at != disturbed_at && stamp != stamp))
            << ix << " " << iy << " in round " << round;
      }
    before = now;
  }
}

TEST(MapMaker, LeavesEarlierMapsUnchanged) {
  Random random(5);
  Ground ground = wavy();
  MapMaker maker({});
  maker.update(ground.view());
  std::vector<TerrainMap> maps;
  std::vector<std::vector<float>> values;
  for (int round = 0; round < 10; ++round) {
    maps.push_back(maker.map());
    values.push_back(maps.back().copy(MapLayer::kTraversability));
    edit(ground, random);
    maker.update(ground.view(round));
  }
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::vector<float> now = maps[i].copy(MapLayer::kTraversability);
    ASSERT_EQ(std::memcmp(now.data(), values[i].data(), now.size() * sizeof(float)), 0) << i;
    if (i > 0) EXPECT_GT(maps[i].sequence(), maps[i - 1].sequence());
  }
}

TEST(MapMaker, ReportsOnlyTheSoilAroundOneBucket) {
  Ground ground = wavy();
  MapMaker maker({});
  ASSERT_EQ(maker.update(ground.view()).size(), 1u);
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = 30; iy < 38; ++iy)
    for (int ix = 50; ix < 60; ++ix) ground.take_above(ix, iy, -1, taken);
  const std::vector<CellRect> changed = maker.update(ground.view(1));
  ASSERT_EQ(changed.size(), 1u);
  // Two columns to each side: the window of 0.2 m.
  EXPECT_EQ(changed[0].x0, 48);
  EXPECT_EQ(changed[0].x1, 62);
  EXPECT_EQ(changed[0].y0, 28);
  EXPECT_EQ(changed[0].y1, 40);
  EXPECT_TRUE(maker.update(ground.view(2)).empty());
}

TEST(MapMaker, CostDependsOnTheChangeAndNotOnTheSite) {
  // A site of 100 m, one bucket of 1.2 m x 1 m a step.
  heightfield::GroundSetup s = setup(1000, 1000);
  s.surface = [](int ix, int iy) { return 0.3 * std::sin(0.11 * ix) + 0.2 * std::cos(0.07 * iy); };
  Ground ground(s);
  MapMaker maker({});
  const auto seconds = [](auto&& work) {
    // Processor time, as other processes may hold the machine.
    const std::clock_t begin = std::clock();
    work();
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  // All layers that a reader may request: the update itself computes nothing.
  const double full = seconds([&] {
    maker.update(ground.view());
    const TerrainMap map = maker.map();
    for (const LayerInfo& each : layers()) map.copy(each.layer);
  });
  std::vector<heightfield::SoilLayer> taken;
  double update = 0;
  constexpr int kBuckets = 50;
  for (int k = 0; k < kBuckets; ++k) {
    const TerrainMap held = maker.map();  // a reader holds the last map, so tiles are copied
    for (int iy = 0; iy < 10; ++iy)
      for (int ix = 0; ix < 12; ++ix) ground.take_above(10 * k + ix, 15 * k + iy, -0.6, taken);
    std::int64_t area = 0;
    update += seconds([&] {
      for (const CellRect& rect : maker.update(ground.view(k))) area += rect.area();
    });
    EXPECT_LE(area, 16 * 14);
  }
  std::printf("100 m: full %.3g s, an update after a bucket %.3g ms, %.0f times less\n", full,
              1e3 * update / kBuckets, full / update * kBuckets);
}

TEST(MapMaker, ReportsSlopeAndStepOfAPlaneWithoutRoughness) {
  const TerrainMap map = map_of(setup(), [](double x, double y) { return 0.3 * x - 0.2 * y; });
  for (const auto& [ix, iy] :
       {std::pair{0, 0}, std::pair{147, 83}, std::pair{147, 0}, std::pair{60, 40}}) {
    // Float heights of a metre are good to 6e-8 m, which is 6e-7 of a slope over two columns.
    EXPECT_NEAR(map.at(MapLayer::kSlope, ix, iy), std::atan(std::hypot(0.3, 0.2)), 2e-6);
    EXPECT_NEAR(map.at(MapLayer::kStepHeight, ix, iy), 0.03, 1e-6);
    EXPECT_NEAR(map.at(MapLayer::kRoughness, ix, iy), 0, 1e-6);
    const double share = std::atan(std::hypot(0.3, 0.2)) / radians(30) + 0.03 / 0.3;
    EXPECT_NEAR(map.at(MapLayer::kTraversability, ix, iy), (3 - share) / 3, 1e-5);
  }
}

TEST(MapMaker, ReportsAWallAsUndrivable) {
  const double wall = 0.4;
  const TerrainMap map = map_of(setup(), [&](double x, double) { return x < 0 ? 0 : wall; });
  // x = 0 lies between columns 32 and 33.
  for (int ix = 20; ix < 50; ++ix) {
    const bool near = ix >= 31 && ix <= 34;  // a window of five columns holds both sides
    EXPECT_NEAR(map.at(MapLayer::kStepHeight, ix, 40), near ? wall : 0, 1e-6) << ix;
    EXPECT_EQ(map.at(MapLayer::kTraversability, ix, 40), near ? 0.0f : 1.0f) << ix;
  }
  // Column 32: a step of five columns x = -2..2, z = 0 0 0 w w. Its line has the slope (w + 2 w) /
  // 10 and the residuals' mean square 0.03 w^2: total 0.24 w^2, explained 0.18 w^2, each of 1/5
  // weight.
  EXPECT_NEAR(map.at(MapLayer::kRoughness, 32, 40), wall * std::sqrt(0.24 - 0.18), 1e-6);
  EXPECT_NEAR(map.at(MapLayer::kSlope, 32, 40), std::atan(wall / 0.2), 1e-6);
}

// Each side of the rut is a step of 0.12 m, far below the limit of 0.3 m, but with a slope of 31
// deg between two columns. A bank with this slope is not drivable.
TEST(MapMaker, ReportsARutAsDrivableAndABankOfTheSameSlopeAsNot) {
  const double deep = 0.12;
  const TerrainMap rut =
      map_of(setup(), [&](double x, double) { return x > -0.5 && x < 0.5 ? -deep : 0; });
  const TerrainMap bank =
      map_of(setup(), [&](double x, double) { return x < 0 ? 0 : deep / 0.2 * x; });
  float steepest = 0;
  for (int ix = 20; ix < 46; ++ix) {
    steepest = std::max(steepest, rut.at(MapLayer::kSlope, ix, 40));
    EXPECT_GT(rut.at(MapLayer::kTraversability, ix, 40), 0) << ix;
  }
  EXPECT_GT(steepest, radians(30));
  EXPECT_EQ(bank.at(MapLayer::kTraversability, 40, 40), 0);
}

TEST(MapMaker, ReportsLayersOfTheSoilPresent) {
  Ground ground{setup()};
  std::vector<heightfield::SoilLayer> taken;
  ground.take_above(5, 6, -0.5, taken);
  ground.put(9, 6, {0, mass_units(1.54), 1.25f, 0});
  const TerrainView columns = ground.view(3);
  const TerrainView view =
      columns.with(heightfield::LooseSoil(columns, {{20, 7, 0.05, 1e-3, 0, 1.1f, 0}}),
                   heightfield::SurfaceKind::kMapped);
  MapMaker maker({});
  maker.update(view);
  const TerrainMap map = maker.map();
  EXPECT_EQ(map.time(), 3);
  EXPECT_NEAR(map.at(MapLayer::kElevation, 5, 6), -0.5, 1e-6);
  // A quantum of mass is 5e-9 m of topsoil
  EXPECT_NEAR(map.at(MapLayer::kElevationStart, 5, 6), 0, 1e-8);
  EXPECT_EQ(map.at(MapLayer::kSoil, 5, 6), 0);  // loam below 0.3 m of topsoil
  EXPECT_EQ(map.at(MapLayer::kSoil, 4, 6), 1);
  EXPECT_EQ(map.at(MapLayer::kDensity, 4, 6), 1100);
  EXPECT_NEAR(map.at(MapLayer::kDensity, 9, 6), 1540 / 1.25, 1e-3);
  // 1.54 kg are 1 l of bank soil and 1.25 l of loose soil
  EXPECT_NEAR(map.at(MapLayer::kElevation, 9, 6), 0.125, 1e-6);
  EXPECT_NEAR(map.at(MapLayer::kLooseDepth, 20, 7), 0.1, 1e-6);
  EXPECT_NEAR(map.at(MapLayer::kElevation, 20, 7), 0.1, 1e-6);
  EXPECT_EQ(map.at(MapLayer::kActive, 20, 7), 1);
  EXPECT_EQ(map.at(MapLayer::kActive, 21, 7), 0);
  EXPECT_TRUE(std::isnan(map.at(MapLayer::kTarget, 5, 6)));
  EXPECT_TRUE(std::isnan(map.at(MapLayer::kCutFill, 5, 6)));
  EXPECT_TRUE(std::isnan(map.at(MapLayer::kElevation, -1, 6)));
  EXPECT_TRUE(std::isnan(map.at(MapLayer::kElevation, 5, 84)));
}

TEST(MapMaker, HoldsRequestedLayersAndTheirBases) {
  MapOptions options;
  options.layers = {MapLayer::kSlope};
  MapMaker maker(options);
  maker.update(wavy().view());
  const TerrainMap map = maker.map();
  EXPECT_TRUE(map.has(MapLayer::kSlope));
  EXPECT_TRUE(map.has(MapLayer::kElevation));
  EXPECT_FALSE(map.has(MapLayer::kRoughness));
  EXPECT_TRUE(std::isnan(map.at(MapLayer::kRoughness, 3, 3)));
}

TEST(MapMaker, RefusesInvalidTargetsAndLimits) {
  MapOptions short_target;
  short_target.target.assign(10, 0.0f);
  EXPECT_THROW(MapMaker(short_target).update(wavy().view()), InputError);
  for (double TraversabilityLimits::*limit :
       {&TraversabilityLimits::slope, &TraversabilityLimits::step_height,
        &TraversabilityLimits::roughness, &TraversabilityLimits::window})
    for (const double wrong : {0.0, -1.0, std::nan(""), 1e9}) {
      MapOptions options;
      options.limits.*limit = wrong;
      EXPECT_THROW(MapMaker(options).update(wavy().view()), InputError) << wrong;
    }
  EXPECT_THROW(MapMaker({}).map(), Error);
}

TEST(Derived, AreUnknownWhereElevationIsAndUseTheKnownNeighboursElsewhere) {
  // A plane with a hole of one column.
  ElevationPatch patch{{0, 0, 9, 9}, 0.5, std::vector<float>(81)};
  for (int iy = 0; iy < 9; ++iy)
    for (int ix = 0; ix < 9; ++ix) patch.z[static_cast<std::size_t>(9 * iy + ix)] = 0.25f * ix;
  patch.z[static_cast<std::size_t>(9 * 4 + 4)] = kUnknown;
  EXPECT_TRUE(std::isnan(slope_at(patch, 4, 4)));
  EXPECT_TRUE(std::isnan(step_height_at(patch, 4, 4, 2)));
  EXPECT_TRUE(std::isnan(plane_at(patch, 4, 4, 2).inclination));
  EXPECT_TRUE(std::isnan(plane_at(patch, 4, 4, 2).roughness));
  for (const int ix : {3, 5}) {
    EXPECT_FLOAT_EQ(slope_at(patch, ix, 4), std::atan(0.5f));
    EXPECT_FLOAT_EQ(step_height_at(patch, ix, 4, 2), 0.25f);
    EXPECT_NEAR(plane_at(patch, ix, 4, 2).inclination, std::atan(0.5), 1e-6);
    EXPECT_NEAR(plane_at(patch, ix, 4, 2).roughness, 0, 1e-7);
  }
  EXPECT_TRUE(std::isnan(traversability(kUnknown, 0, 0, {})));
  EXPECT_EQ(traversability(0, 0, 0, {}), 1);
  EXPECT_EQ(traversability(0, 0.3f, 0, {}), 0);
}

TEST(Layers, HaveOneRowEachAndAreFoundByName) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    EXPECT_EQ(index_of(layers()[i].layer), i);
    EXPECT_EQ(layer_named(layers()[i].name), layers()[i].layer);
    names.insert(layers()[i].name);
  }
  EXPECT_EQ(names.size(), kMapLayers);
  EXPECT_EQ(layers_named("slope,soil,slope"),
            (std::vector<MapLayer>{MapLayer::kSlope, MapLayer::kSoil}));
  EXPECT_THROW(layers_named(""), InputError);
  try {
    layers_named("elevation,slop");
    FAIL() << "'slop' was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'slope'?"), std::string::npos)
        << error.what();
  }
}

TEST(Layers, MatchTheNormalAndChangeOfAPlane) {
  heightfield::GroundSetup setup = testing::setup();
  setup.surface = [](int ix, int iy) { return 0.05 * ix - 0.02 * iy; };
  heightfield::Ground ground(setup);
  std::vector<heightfield::SoilLayer> taken;
  ground.take_above(40, 33, ground.height(40, 33) - 0.5, taken);
  const heightfield::TerrainView view = ground.view();
  const heightfield::CellRect rect{35, 30, 50, 40};
  const auto at = [&](MapLayer layer, int ix, int iy) {
    return layer_values(view, layer, rect).at(static_cast<std::size_t>((iy - 30) * 15 + ix - 35));
  };
  EXPECT_EQ(at(MapLayer::kElevation, 38, 32), static_cast<float>(view.height(38, 32)));
  EXPECT_NEAR(at(MapLayer::kChange, 40, 33), -0.5, 1e-6);
  EXPECT_EQ(at(MapLayer::kChange, 41, 33), 0);
  EXPECT_EQ(at(MapLayer::kSpecificVolume, 41, 33), 1);
  // The plane rises by 0.5 along x and falls by 0.2 along y.
  const Vec3 n = Vec3(-0.5, 0.2, 1).normalized();
  EXPECT_NEAR(at(MapLayer::kNormalX, 47, 38), n.x(), 1e-6);
  EXPECT_NEAR(at(MapLayer::kNormalY, 47, 38), n.y(), 1e-6);
  EXPECT_NEAR(at(MapLayer::kNormalZ, 47, 38), n.z(), 1e-6);
  EXPECT_NEAR(at(MapLayer::kSlope, 47, 38), std::acos(n.z()), 1e-6);
}

TEST(Layers, AreFoundByTheirOldNames) { EXPECT_EQ(layer_named("awake"), MapLayer::kActive); }

TEST(Layers, HaveOneRuleEach) {
  for (const LayerInfo& each : layers()) {
    const int rules = (each.of_column != nullptr ? 1 : 0) + (each.of_surround != nullptr ? 1 : 0);
    EXPECT_EQ(rules, each.needs == LayerNeeds::kHistory ? 0 : 1) << each.name;
    // A layer of surroundings reads the elevation of the map.
    if (each.of_surround != nullptr)
      EXPECT_NE(std::count(each.from.begin(), each.from.end(), MapLayer::kElevation), 0)
          << each.name;
  }
}

}  // namespace
}  // namespace navvy::map
