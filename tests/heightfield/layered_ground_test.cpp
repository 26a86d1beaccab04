// SPDX-License-Identifier: Apache-2.0
#include "heightfield/layered_ground.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "flip_bytes.h"
#include "heightfield/grounds.h"
#include "heightfield/volume_change.h"

namespace navvy::heightfield {
namespace {

using testing::total;
using testing::wavy_setup;

// One mass unit over a 0.1 m column of 1100 kg/m3 is 5.4e-9 m thick; heights are sums of a few such
// roundings.
constexpr double kHeightQuantum = 2e-8;

std::vector<std::int64_t> per_soil(const std::vector<SoilLayer>& layers, std::size_t soils) {
  std::vector<std::int64_t> mass(soils, 0);
  for (const SoilLayer& layer : layers) mass[layer.soil] += layer.mass;
  return mass;
}

std::uint64_t digest(const Ground& ground) { return hash_of(ground).digest(); }

// Digs and fills at random; soil that was taken is put back elsewhere or kept in `taken`.
void work(Ground& ground, Random& random, int edits, std::vector<SoilLayer>& taken) {
  for (int n = 0; n < edits; ++n) {
    const int ix = static_cast<int>(random.uniform(0, ground.nx())),
              iy = static_cast<int>(random.uniform(0, ground.ny()));
    switch (random.next() % 3) {
      case 0:
        ground.take_above(ix, iy, ground.height(ix, iy) - random.uniform(0, 0.8), taken);
        break;
      case 1:
        if (!taken.empty()) {
          SoilLayer layer = taken.back();
          taken.pop_back();
          layer.specific_volume = static_cast<float>(random.uniform(1.0, 1.25));
          layer.plastic_shear = static_cast<float>(random.uniform(0.0, 2.0));
          ground.put(ix, iy, layer);
        }
        break;
      default:
        ground.compact_to(ix, iy, ground.height(ix, iy) - random.uniform(0, 0.03));
    }
  }
}

TEST(Ground, PristineAndMaterialisedHeightsAgreeBitForBit) {
  Ground ground(wavy_setup());
  const Ground untouched(wavy_setup());
  // Touch every column: put soil on it, take everything above its initial height off again, and put
  // the rest back.
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double before = ground.height(ix, iy);
      ground.put(ix, iy, {0, 1000000, 1.2f, 1.0f});
      std::vector<SoilLayer> taken;
      ground.take_above(ix, iy, before, taken);
      ASSERT_EQ(total(taken), 1000000);
      ASSERT_EQ(ground.height(ix, iy), before);
      ASSERT_EQ(ground.height(ix, iy), untouched.height(ix, iy));
      ASSERT_EQ(ground.start_height(ix, iy), untouched.height(ix, iy));
      ASSERT_NEAR(before, wavy_setup().surface(ix, iy), kHeightQuantum);
    }
  EXPECT_EQ(ground.touched_tiles(), 6u);
  EXPECT_EQ(untouched.touched_tiles(), 0u);
  for (const std::int64_t change : ground.mass_change()) EXPECT_EQ(change, 0);
}

TEST(Ground, HasTwoSoilsWithTheMassOfTheirThickness) {
  Ground::Setup setup = wavy_setup();
  setup.patches = {{Vec2(0, 2), Vec2(1, 3), {{"loam", 9}}}};
  const Ground ground(std::move(setup));
  const std::vector<SoilLayer> layers = ground.layers(5, 7);
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_EQ(ground.surface_soil(5, 7), 1);
  EXPECT_EQ(layers[1].soil, 1);
  EXPECT_EQ(layers[0].soil, 0);
  // Half a unit of rounding.
  EXPECT_NEAR(kilograms(layers[1].mass), 1100 * 0.01 * 0.3, kMassQuantum);
  EXPECT_NEAR(kilograms(layers[0].mass), 1540 * 0.01 * (ground.height(5, 7) + 3 - 0.3),
              2 * kMassQuantum);
  // Inside the patch there is loam only.
  const Vec2i c = ground.column_at(0.5, 2.5);
  EXPECT_EQ(ground.layers(c.x(), c.y()).size(), 1u);
  EXPECT_EQ(ground.surface_soil(c.x(), c.y()), 0);
}

TEST(Ground, KeepsTheLedgerExactUnderRandomWork) {
  Ground ground(wavy_setup());
  Random random(7);
  std::vector<SoilLayer> taken;
  for (int round = 0; round < 20; ++round) {
    work(ground, random, 1000, taken);
    const auto change = ground.mass_change();
    const auto out = per_soil(taken, 2);
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_EQ(change[i] + out[i], 0) << "soil " << i << " round " << round;
  }
}

TEST(Ground, VolumesFromHeightsAgreeWithMass) {
  Ground ground(wavy_setup());
  Random random(9);
  std::vector<SoilLayer> taken;
  work(ground, random, 5000, taken);
  // Compares the volume of every column from its layers with its height.
  double from_layers = 0, from_heights = 0;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      for (const SoilLayer& layer : ground.layers(ix, iy))
        from_layers += kilograms(layer.mass) * layer.specific_volume /
                       ground.setup().soils[layer.soil].bank_density;
      from_heights += (ground.height(ix, iy) - ground.datum()) * 0.01;
    }
  // The required bound; the actual error is rounding of doubles.
  EXPECT_NEAR(from_heights / from_layers, 1, 1e-5);
  // A dig of bank soil: volume = mass / density.
  Ground fresh(wavy_setup());
  std::vector<SoilLayer> dug;
  for (int iy = 10; iy < 20; ++iy)
    for (int ix = 10; ix < 40; ++ix) fresh.take_above(ix, iy, fresh.height(ix, iy) - 0.25, dug);
  const testing::VolumeChange change = testing::volume_change(fresh);
  EXPECT_EQ(change.raised, 0);
  EXPECT_NEAR(change.lowered / (kilograms(total(dug)) / 1100), 1, 1e-5);
}

TEST(Ground, TakesDownToTheRequestedHeight) {
  Ground ground(wavy_setup());
  Random random(3);
  for (int n = 0; n < 2000; ++n) {
    const int ix = static_cast<int>(random.uniform(0, 77)),
              iy = static_cast<int>(random.uniform(0, 45));
    const double z = random.uniform(-3.2, 1.0), before = ground.height(ix, iy);
    std::vector<SoilLayer> taken;
    ground.take_above(ix, iy, z, taken);
    EXPECT_NEAR(ground.height(ix, iy), std::max(std::min(z, before), -3.0), kHeightQuantum);
  }
}

TEST(Ground, CompactsTheTopFirstAndKeepsMass) {
  Ground ground(wavy_setup());
  const double before = ground.height(30, 30);
  const std::int64_t mass = total(ground.layers(30, 30));
  ground.compact_to(30, 30, before - 0.02);
  // Float specific volume of a 0.2 m layer.
  EXPECT_NEAR(ground.height(30, 30), before - 0.02, 1e-7);
  EXPECT_EQ(total(ground.layers(30, 30)), mass);
  const std::vector<SoilLayer> layers = ground.layers(30, 30);
  EXPECT_LT(layers.back().specific_volume, 0.95f);
  EXPECT_EQ(layers.front().specific_volume, 1.0f);
  // No pressure compacts beyond the largest density.
  ground.compact_to(30, 30, -100);
  for (const SoilLayer& layer : ground.layers(30, 30)) EXPECT_GE(layer.specific_volume, 0.85f);
  EXPECT_EQ(total(ground.layers(30, 30)), mass);
}

TEST(Ground, CompactsNoDeeperThanTheDrop) {
  // A compacted zone over untouched soil, which must not be cut into layers. Near height 0 drops
  // have finer digits than the rest of a layer, so that their difference is not exactly zero.
  Ground::Setup level = wavy_setup();
  level.surface = [](int, int) { return 0.0; };
  Ground ground(std::move(level));
  Random random(3);
  for (int iy = 0; iy < 20; ++iy)
    for (int ix = 0; ix < 20; ++ix) {
      const std::size_t before = ground.layers(ix, iy).size();
      for (int n = 0; n < 5; ++n)
        ground.compact_to(ix, iy, ground.height(ix, iy) - random.uniform(0.001, 0.004));
      EXPECT_LE(ground.layers(ix, iy).size(), before + 1) << ix << " " << iy;
    }
}

TEST(Ground, StaysShortUnderEndlessEdits) {
  Ground ground(wavy_setup());
  Random random(5);
  for (int n = 0; n < 3000; ++n) {
    ground.put(
        3, 3,
        {static_cast<std::uint16_t>(n < 1500 ? 0 : 1), 500000,
         static_cast<float>(random.uniform(1, 1.25)), static_cast<float>(random.uniform(0, 3))});
    ground.compact_to(3, 3, ground.height(3, 3) - random.uniform(0, 0.01));
  }
  EXPECT_LE(ground.layers(3, 3).size(), 16u);
}

TEST(Ground, AnnouncesItsChanges) {
  Ground ground(wavy_setup());
  EXPECT_TRUE(ground.changed_since(0).empty());
  ground.put(5, 6, {0, 10, 1, 0});
  const std::uint64_t first = ground.sequence();
  ground.put(50, 40, {0, 10, 1, 0});
  const CellRect recent = ground.changed_since(first);
  EXPECT_EQ(recent.x0, 50);
  EXPECT_EQ(recent.y0, 40);
  EXPECT_EQ(recent.x1, 51);
  EXPECT_EQ(recent.y1, 41);
  const CellRect all = ground.changed_since(0);
  EXPECT_EQ(all.x0, 5);
  EXPECT_EQ(all.y1, 41);
  EXPECT_TRUE(ground.changed_since(ground.sequence()).empty());
  // After many edits the newest are still exact, and the oldest are covered.
  for (int n = 0; n < 100000; ++n) ground.put(10 + n % 20, 10 + n / 20 % 20, {0, 10, 1, 0});
  const std::uint64_t late = ground.sequence();
  ground.put(70, 3, {0, 10, 1, 0});
  EXPECT_EQ(ground.changed_since(late).x0, 70);
  EXPECT_EQ(ground.changed_since(0).x0, 5);
  EXPECT_EQ(ground.changed_since(0).y1, 41);
  // No change, no announcement.
  std::vector<SoilLayer> none;
  ground.take_above(1, 1, 100, none);
  ground.compact_to(1, 1, 100);
  EXPECT_EQ(ground.sequence(), late + 1);
}

TEST(Ground, SavesAndLoadsToTheSameHash) {
  Ground ground(wavy_setup());
  Random random(11);
  std::vector<SoilLayer> taken;
  work(ground, random, 3000, taken);
  Ground other(wavy_setup());
  other.put(1, 1, {0, 77, 1, 0});
  load_saved(saved(ground), other);
  EXPECT_EQ(digest(other), digest(ground));
  EXPECT_EQ(other.mass_change(), ground.mass_change());
  EXPECT_EQ(other.sequence(), ground.sequence());
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) ASSERT_EQ(other.height(ix, iy), ground.height(ix, iy));
  // Both continue equally, and one more unit is a different state.
  Random a(12), b(12);
  std::vector<SoilLayer> taken_b = taken;
  work(ground, a, 500, taken);
  work(other, b, 500, taken_b);
  EXPECT_EQ(digest(other), digest(ground));
  other.put(2, 2, {0, 1, 1, 0});
  EXPECT_NE(digest(other), digest(ground));
}

TEST(Ground, RefusesASnapshotOfAnotherSiteOrADamagedOne) {
  Ground ground(wavy_setup());
  ground.put(1, 1, {0, 77, 1, 0});
  const std::vector<char> state = saved(ground);
  Ground other(wavy_setup(78, 45));
  EXPECT_THROW(load_saved(state, other), InputError);
  EXPECT_THROW(load_saved({state.begin(), state.end() - 9}, ground), InputError);
}

TEST(Ground, EverySavedByteIsHashedOrRefused) {
  Ground ground(wavy_setup()), target(wavy_setup());
  Random random(13);
  std::vector<SoilLayer> taken;
  work(ground, random, 60, taken);
  ground.hold({5, 100, 101});
  EXPECT_EQ(test::flip_every_byte(ground, target), "");
}

TEST(Ground, RefusesImpossibleColumns) {
  Ground ground(wavy_setup()), target(wavy_setup());
  ground.put(76, 44, {0, 77, 1.5f, 0.25f});
  ByteMap map;
  const std::vector<char> state = saved(ground, &map);
  // A field of that name with other bytes is refused by its name.
  const auto refused = [&](const std::string& name, const auto& value) {
    const auto field = std::find_if(
        map.fields.begin(), map.fields.end(),
        [&](const ByteMap::Field& f) { return f.path.ends_with(name) && f.size != 8; });
    std::vector<char> bytes = state;
    std::memcpy(bytes.data() + field->offset, &value, sizeof value);
    try {
      load_saved(bytes, target);
    } catch (const InputError& error) {
      return std::string(error.what()).find(name) != std::string::npos;
    }
    return false;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused("place", std::uint16_t{1023}))
      << "beyond the corner of the site, but in its tile";
  EXPECT_TRUE(refused("place", std::uint16_t{1024}));
  EXPECT_TRUE(refused("layers", std::uint32_t{0xffffffff}));
  EXPECT_TRUE(refused("soil", std::uint16_t{7}));
  EXPECT_TRUE(refused("specific_volume", 0.0f));
  EXPECT_TRUE(refused("specific_volume", nan));
  EXPECT_TRUE(refused("plastic_shear", nan));
  EXPECT_TRUE(refused("edits", CellRect{1, 1, 1 << 30, 2}))
      << "the soil would search tiles endlessly";
  EXPECT_NO_THROW(load_saved(state, target));
}

TEST(Ground, TouchesLittleMemoryOnASquareKilometre) {
  Ground::Setup setup = wavy_setup(10000, 10000);
  setup.surface = [](int ix, int iy) { return 1e-4 * ix + 2e-4 * iy; };
  const std::size_t bytes_before = ::mallinfo2().uordblks;
  Ground ground(std::move(setup));
  for (int n = 0; n < 100; ++n) {
    std::vector<SoilLayer> taken;
    ground.take_above(40 + n % 10, 8888 + n / 10, -0.5, taken);
  }
  // A tile holds 18 KiB of heights and slots and its changed columns; the cache at most 8 MiB.
  EXPECT_LE(ground.touched_tiles(), 4u);
  const std::size_t bytes_after = ::mallinfo2().uordblks;
  // Tables of the site, four tiles and their cache: 0.2 MB
  EXPECT_LT(bytes_after - bytes_before, 1u << 20);
}

TEST(Ground, SamplesBilinearlyAndExtendsItsEdge) {
  const Ground ground(wavy_setup());
  const Vec2& o = ground.origin();
  EXPECT_NEAR(ground.sample(o.x() + 0.05 + 0.1 * 31, o.y() + 0.05 + 0.1 * 31),
              ground.height(31, 31), 1e-12);
  const double mean = (ground.height(31, 31) + ground.height(32, 31) + ground.height(31, 32) +
                       ground.height(32, 32)) /
                      4;
  EXPECT_NEAR(ground.sample(o.x() + 3.2, o.y() + 3.2), mean, 1e-12);
  EXPECT_EQ(ground.sample(-1e6, -1e6), ground.height(0, 0));
  EXPECT_EQ(ground.sample(1e6, 1e6), ground.height(76, 44));
  EXPECT_EQ(ground.height(-5, 3), ground.height(0, 3));
  // The normal is that of the bilinear surface: central difference of samples inside one dual cell.
  const double x = o.x() + 2.07, y = o.y() + 3.02, e = 1e-5;
  const Vec3 expected = Vec3(-(ground.sample(x + e, y) - ground.sample(x - e, y)) / (2 * e),
                             -(ground.sample(x, y + e) - ground.sample(x, y - e)) / (2 * e), 1)
                            .normalized();
  EXPECT_LT((ground.normal(x, y) - expected).norm(), 1e-6);  // rounding over 2e-5 m
  EXPECT_TRUE(std::isfinite(ground.sample(std::numeric_limits<double>::quiet_NaN(), 0)));
}

TEST(Ground, RayAgreesWithSmallSteps) {
  Ground ground(wavy_setup());
  Random random(21);
  std::vector<SoilLayer> taken;
  work(ground, random, 300, taken);
  int hits = 0;
  for (int n = 0; n < 400; ++n) {
    const Vec3 p(random.uniform(-5, 6), random.uniform(0, 7), random.uniform(0.5, 2.5));
    Vec3 d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.6, 0.1));
    if (n % 7 == 0) d = Vec3(0, 0, -1);
    if (n % 11 == 0) d.x() = 0;
    d.normalize();
    const double range = 9, step = 0.0005;
    double expected = -1;
    for (double t = 0; t <= range; t += step) {
      const Vec3 q = p + t * d;
      if (q.z() <= ground.sample(q.x(), q.y())) {
        expected = t;
        break;
      }
    }
    const double found = ground.ray(p, d, range);
    if (expected == 0) {
      EXPECT_EQ(found, 0);  // it started in the soil
      continue;
    }
    if (expected < 0) {
      // Small steps may miss a ray that grazes an edge for less than a step.
      if (found >= 0) {
        const Vec3 q = p + found * d;
        EXPECT_NEAR(q.z(), ground.sample(q.x(), q.y()), 1e-9);
      }
      continue;
    }
    ++hits;
    ASSERT_GE(found, 0) << n;
    EXPECT_LE(found, expected + 1e-9);  // small steps may pass an edge that the exact ray touches
    const Vec3 q = p + found * d;
    EXPECT_NEAR(q.z(), ground.sample(q.x(), q.y()), 1e-9);  // it lies on the surface
  }
  EXPECT_GT(hits, 150);
  EXPECT_EQ(ground.ray(Vec3(0, 3, 50), Vec3(0, 0, 1), 100), -1);
  EXPECT_EQ(ground.ray(Vec3(0, 3, -2), Vec3(0, 0, 1), 100), 0);
}

TEST(Ground, CopiesHeightsOfAnyRectangle) {
  Ground ground(wavy_setup());
  ground.put(40, 40, {0, 50000000, 1, 0});
  const CellRect rect{-3, 20, 80, 50};
  std::vector<float> heights;
  ground.copy_heights(rect, heights);
  ASSERT_EQ(heights.size(), 83u * 30u);
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix)
      ASSERT_EQ(heights[(iy - rect.y0) * 83 + ix - rect.x0],
                static_cast<float>(ground.height(ix, iy)));
}

TEST(Ground, ReportsTheHighestColumnOfAnyRectangle) {
  Ground ground(wavy_setup());
  ground.put(40, 40, {0, 50000000, 1, 0});
  std::vector<SoilLayer> taken;
  ground.take_above(12, 3, -1, taken);
  for (const CellRect rect :
       {CellRect{-3, 20, 80, 50}, CellRect{0, 0, 77, 45}, CellRect{12, 3, 13, 4},
        CellRect{30, 30, 70, 44}, CellRect{-9, -9, -2, -5}, CellRect{90, 60, 91, 61}}) {
    double highest = -1e9;
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix) highest = std::max(highest, ground.height(ix, iy));
    EXPECT_EQ(ground.highest(rect), highest);
  }
  EXPECT_EQ(ground.highest({4, 4, 4, 9}), -std::numeric_limits<double>::infinity());
}

TEST(Ground, HoldsTheNamedColumnsAndCountsReleasedOnesAsChanged) {
  Ground ground(wavy_setup());
  const auto key = [&](int ix, int iy) { return static_cast<std::int64_t>(iy) * ground.nx() + ix; };
  ground.hold({key(3, 4), key(5, 4)});
  EXPECT_TRUE(ground.held(3, 4));
  EXPECT_FALSE(ground.held(4, 3));
  const std::uint64_t before = ground.sequence();
  ground.hold({key(5, 4), key(6, 4)});
  EXPECT_FALSE(ground.held(3, 4));
  EXPECT_TRUE(ground.held(6, 4));
  const CellRect let_go = ground.changed_since(before);
  EXPECT_EQ(let_go.x0, 3);
  EXPECT_EQ(let_go.x1, 4);
  EXPECT_EQ(let_go.y0, 4);
  EXPECT_EQ(ground.touched_tiles(), 0u);  // no column was made
  const std::uint64_t same = ground.sequence();
  ground.hold({key(5, 4), key(6, 4)});
  EXPECT_EQ(ground.sequence(), same);
  EXPECT_THROW(ground.hold({-1}), Error);
  EXPECT_THROW(ground.hold({key(0, ground.ny())}), Error);
  EXPECT_TRUE(ground.held(5, 4));
}

TEST(Ground, RefusesInvalidInput) {
  Ground::Setup setup = wavy_setup();
  setup.nx = 0;
  setup.cell = std::numeric_limits<double>::quiet_NaN();
  setup.layers[0].soil = "moon dust";
  setup.soils[0].bank_density = 0;
  try {
    Ground ground(setup);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().size(), 4u) << error.what();
    EXPECT_NE(std::string(error.what()).find("moon dust"), std::string::npos);
  }
  Ground::Setup holes = wavy_setup();
  holes.surface = [](int ix, int) {
    return ix == 40 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  };
  const Ground ground(holes);
  EXPECT_EQ(ground.height(3, 3), 0);
  EXPECT_THROW(ground.height(40, 3), InputError);
  Ground good(wavy_setup());
  EXPECT_THROW(good.put(0, 0, {9, 5, 1, 0}), Error);
  EXPECT_THROW(good.put(0, 0, {0, -5, 1, 0}), Error);
  EXPECT_THROW(good.put(-1, 0, {0, 5, 1, 0}), Error);
}

}  // namespace
}  // namespace navvy::heightfield
