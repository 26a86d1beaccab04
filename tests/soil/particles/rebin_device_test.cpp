// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/rebin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

}  // namespace
}  // namespace navvy::soil
