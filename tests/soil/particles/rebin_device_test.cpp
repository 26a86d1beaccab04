// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/rebin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "soil/particles/schedule.h"
#include "soil/particles/stages.h"

namespace navvy::soil {
namespace {

double at(const Particle& p, int axis) {
  return kBlockCells * p.block[axis] + static_cast<double>(p.x[axis]);
}

TEST(Rebin, SortsParticlesWhereTheHostWouldHavePutThem) {
  for (const int count : {1, 17, 413}) {
    // Blocks before a drift of up to 0.7 cells, which a re-bin finds in the store.
    ParticleStore store(rig::Rig::device(), {0, 0, 200, 200},
                        soil_table({rig::sand()}, kStageCell));
    store.assign(strewn(count));
    std::vector<Particle> drifted = store.records();
    for (std::size_t i = 0; i < drifted.size(); ++i)
      for (int a = 0; a < 3; ++a)
        drifted[i].x[a] += 0.7f * std::sin(static_cast<float>(7 * i) + static_cast<float>(a));
    store.place(drifted);
    const std::vector<Particle> before = store.records();
    EXPECT_TRUE(store.rebin().empty());
    const std::vector<Particle> after = store.records(), expected = ParticleStore::sorted(before);
    ASSERT_EQ(after.size(), expected.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      for (int a = 0; a < 3; ++a) {
        EXPECT_EQ(after[i].block[a], expected[i].block[a]);
        EXPECT_EQ(std::floor(after[i].x[a] - 0.5f), std::floor(expected[i].x[a] - 0.5f))
            << "another cell";
      }
    }
    // The same particles with the same words, in any order inside a cell.
    const auto by_id = [](std::vector<Particle> list) {
      std::sort(list.begin(), list.end(),
                [](const Particle& a, const Particle& b) { return a.id < b.id; });
      return list;
    };
    const std::vector<Particle> was = by_id(before), is = by_id(after);
    for (std::size_t i = 0; i < is.size(); ++i) {
      ASSERT_EQ(is[i].id, was[i].id);
      EXPECT_EQ(is[i].mass, was[i].mass);
      EXPECT_EQ(is[i].j, was[i].j);
      for (int k = 0; k < 9; ++k) EXPECT_EQ(is[i].c[k], was[i].c[k]);
      // A float of 4 cells.
      for (int a = 0; a < 3; ++a) EXPECT_NEAR(at(is[i], a), at(was[i], a), 1e-6);
    }
  }
}

TEST(Rebin, GivesBackWhatLeftTheSite) {
  ParticleStore store(rig::Rig::device(), {0, 0, 41, 200}, soil_table({rig::sand()}, kStageCell));
  const std::vector<Particle> particles = strewn(100);
  const auto beyond = std::count_if(particles.begin(), particles.end(),
                                    [](const Particle& p) { return at(p, 0) >= 41; });
  store.assign(particles);
  EXPECT_EQ(static_cast<std::ptrdiff_t>(store.rebin().size()), beyond);
  EXPECT_GT(beyond, 0);
  for (const Particle& p : store.records()) EXPECT_LT(at(p, 0), 41);
}

TEST(Rebin, OfNothingIsNothing) {
  ParticleStore store(rig::Rig::device(), {0, 0, 200, 200}, soil_table({rig::sand()}, kStageCell));
  EXPECT_TRUE(store.rebin().empty());
  EXPECT_EQ(store.count(), 0);
  const RebinPlan plan = plan_rebin(BlockTable{}, {});
  EXPECT_TRUE(plan.keys.empty());
}

/// Stored particles of two soils that have drifted by up to 0.7 cells.
std::vector<Particle> drifted(int count) {
  ParticleStore store(rig::Rig::device(), {0, 0, 200, 200}, soil_table({rig::sand()}, kStageCell));
  store.assign(strewn(count));
  std::vector<Particle> out = store.records();
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (int a = 0; a < 3; ++a)
      out[i].x[a] += 0.7f * std::sin(static_cast<float>(7 * i) + static_cast<float>(a));
    out[i].soil = static_cast<std::uint16_t>(i % 2);
    // Sides are copied with the soils.
    out[i].side = static_cast<std::uint16_t>(i % 3);
  }
  return out;
}

/// A particle, word by word.
using Words = std::array<std::uint32_t, sizeof(Particle) / sizeof(std::uint32_t)>;

/// Expects that both stores hold the same words in the same order.
void expect_same(const ParticleStore& one, const ParticleStore& other) {
  const std::vector<Particle> a = one.records(), b = other.records();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(std::bit_cast<Words>(a[i]), std::bit_cast<Words>(b[i])) << "particle " << i;
  ASSERT_TRUE(one.table().particle_blocks == other.table().particle_blocks);
  ASSERT_TRUE(one.table().active == other.table().active);
  for (std::size_t h = 0; h < one.particle_blocks().size(); ++h) {
    EXPECT_EQ(one.particle_blocks()[h].start, other.particle_blocks()[h].start);
    EXPECT_EQ(one.particle_blocks()[h].count, other.particle_blocks()[h].count);
  }
}

/// Changes a store of `count` particles on the device and, as reference, on the host: removes those
/// for which `removes(i)` is true, adds `added`.
template <class Removes>
void expect_change(int count, const Removes& removes, const std::vector<Particle>& added) {
  const std::vector<SoilRow> soils = soil_table({rig::sand(), rig::sand(20)}, kStageCell);
  ParticleStore store(rig::Rig::device(), {0, 0, 200, 200}, soils),
      reference(rig::Rig::device(), {0, 0, 200, 200}, soils);
  store.place(drifted(count));
  std::vector<Particle> all = store.records(), stay;
  std::vector<std::uint8_t> removed(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    removed[i] = removes(i) ? 1 : 0;
    if (removed[i] == 0) stay.push_back(all[i]);
  }
  stay.insert(stay.end(), added.begin(), added.end());
  store.change(removed, added);
  reference.assign(stay);
  expect_same(store, reference);
  // Lanes without a particle are at rest, whatever was stored there before.
  const std::vector<float> words = store.state().read();
  const auto capacity = static_cast<std::size_t>(store.capacity());
  for (const ParticleBlock& block : store.particle_blocks())
    for (int slot = block.start + block.count; slot % NAVVY_LANES != 0; ++slot) {
      EXPECT_EQ(words[FIELD_X * capacity + static_cast<std::size_t>(slot)], 2.0f);
      EXPECT_EQ(words[FIELD_MASS * capacity + static_cast<std::size_t>(slot)], 0.0f);
    }
  // Surfaces: means that work-groups sum in another order than lanes and the host.
  const float rounding = schedule_for(rig::Rig::device()) == Schedule::kGroups ? 1e-6f : 0;
  const std::size_t blocks = store.particle_blocks().size();
  std::vector<ContactSoil> found(blocks), expected(blocks);
  store.block_surface().read(found);
  reference.block_surface().read(expected);
  for (std::size_t h = 0; h < blocks; ++h)
    EXPECT_NEAR(found[h].friction, expected[h].friction, rounding) << "block " << h;
  // A further re-bin works on the new blocks.
  store.rebin();
  EXPECT_EQ(store.count(), static_cast<int>(stay.size()));
}

/// Particles to be added: as many as asked for, in the blocks of strewn() and beyond.
std::vector<Particle> further(int count) {
  std::vector<Particle> out = strewn(count);
  for (Particle& p : out) {
    p.x[0] += 1.3f * static_cast<float>(p.id % 5);
    p.id += 100000;
    p.soil = p.id % 4 == 0;
  }
  return out;
}

TEST(ChangeOfParticles, EqualsANewStoreOfThoseThatStayAndThoseThatCome) {
  for (const int count : {1, 17, 413, 2100})
    for (const int more : {0, 1, 40, 700}) {
      SCOPED_TRACE(std::to_string(count) + " particles and " + std::to_string(more) + " more");
      expect_change(
          count, [](std::size_t i) { return i % 3 == 1; }, further(more));
      expect_change(
          count, [](std::size_t) { return false; }, further(more));
      expect_change(
          count, [](std::size_t) { return true; }, further(more));
      // Whole blocks, as the exchange deposits them.
      expect_change(
          count, [&](std::size_t i) { return i < static_cast<std::size_t>(count) / 2; },
          further(more));
    }
}

TEST(ChangeOfParticles, OfAnEmptyStoreAddsParticles) {
  expect_change(
      0, [](std::size_t) { return false; }, further(30));
  expect_change(0, [](std::size_t) { return false; }, {});
}

// 0.5 cells are the edge between two cells; a float just below it is rounded up in the block below.
TEST(ChangeOfParticles, PutsParticlesAtTheEdgeOfACellWhereTheHostDoes) {
  ParticleStore store(rig::Rig::device(), {0, 0, 200, 200}, soil_table({rig::sand()}, kStageCell)),
      reference(rig::Rig::device(), {0, 0, 200, 200}, soil_table({rig::sand()}, kStageCell));
  std::vector<Particle> particles = strewn(200);
  const float below = 0.5f - std::numeric_limits<float>::epsilon() / 4,
              edges[] = {below, 0.5f, 4.5f, 0.0f, 4.0f};
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      particles[i].block[a] = 10;
      particles[i].x[a] = edges[(i / (a == 0 ? 1 : a == 1 ? 5 : 25)) % 5];
    }
  std::stable_sort(particles.begin(), particles.end(),
                   [](const Particle& p, const Particle& q) { return p.id < q.id; });
  store.place(particles);
  const std::vector<Particle> all = store.records();
  store.change({}, {});
  reference.assign(all);
  expect_same(store, reference);
}

TEST(ChangeOfParticles, KeepsThoseBeyondTheSite) {
  ParticleStore store(rig::Rig::device(), {0, 0, 41, 200}, soil_table({rig::sand()}, kStageCell));
  store.assign(strewn(100));
  store.change({}, further(3));
  EXPECT_EQ(store.count(), 103);
}

}  // namespace
}  // namespace navvy::soil
