// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/grid_update.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "soil/host_law/double_contact.h"
#include "soil/particles/floor.h"
#include "soil/particles/stages.h"

namespace navvy::soil {
namespace {

/// Returns node velocities and masses per free volume, four numbers each, of all active blocks.
std::vector<float> nodes_of(Stages& stages, const Vec3& dv) {
  stages.enqueue_scatter();
  stages.enqueue_grid(dv);
  std::vector<float> out = stages.grid.velocity().read();
  out.resize(4 * BLOCK_NODES * stages.store.table().active.size());
  return out;
}

TEST(GridUpdate, KeepsMomentumAndAddsGravityFarFromTheGround) {
  for (const int count : {1, 17, 200}) {
    const std::vector<Particle> particles = strewn(count);
    Stages stages(particles);
    const Vec3 dv(0.1, 0.2, -0.3);
    const std::vector<float> nodes = nodes_of(stages, dv);
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::size_t n = 0; n < nodes.size(); n += 4) {
      const auto m = static_cast<double>(nodes[n + 3]);
      for (std::size_t k = 0; k < 3; ++k)
        sum[static_cast<int>(k)] += m * static_cast<double>(nodes[n + k]);
      sum[3] += m;
    }
    Eigen::Vector4d expected = sum_of(particles);
    expected.head<3>() += expected[3] * dv;
    // Floats; nodes lighter than a mass quantum, 2^-24 kg, lose their momentum.
    EXPECT_LT((sum - expected).cwiseAbs().maxCoeff(), 1e-5 * 0.2 * count) << count;
  }
}

/// Returns the indices of node `i` of the result of nodes_of().
std::array<int, 3> node_at(const BlockTable& table, std::size_t i) {
  const BlockKey& block = table.active[i / BLOCK_NODES];
  const int n = static_cast<int>(i % BLOCK_NODES);
  return {kBlockCells * block.x + n % 4, kBlockCells * block.y + n / 4 % 4,
          kBlockCells * block.z + n / 16};
}

std::map<std::array<int, 3>, double> masses_of(const BlockTable& table,
                                               const std::vector<float>& nodes) {
  std::map<std::array<int, 3>, double> masses;
  for (std::size_t i = 0; i < nodes.size() / 4; ++i)
    masses[node_at(table, i)] = static_cast<double>(nodes[4 * i + 3]);
  return masses;
}

TEST(GridUpdate, HoldsNodesInTheGroundAndReportsMassPerFreeVolumeAboveIt) {
  // Ground through the middle of the scattered particles.
  const std::vector<Particle> particles = strewn(200);
  Stages open(particles), stages(particles, 40);
  const std::vector<float> free_nodes = nodes_of(open, Vec3::Zero()),
                           nodes = nodes_of(stages, Vec3::Zero());
  const BlockTable& table = stages.store.table();
  const std::map<std::array<int, 3>, double> masses = masses_of(table, free_nodes);
  int held = 0, falling = 0;
  for (std::size_t i = 0; i < nodes.size() / 4; ++i) {
    const std::array<int, 3> at = node_at(table, i);
    const double above = at[2] - 40;
    const auto mass = static_cast<double>(free_nodes[4 * i + 3]);
    const bool fixed = above <= kScheme.held_margin;
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(nodes[4 * i + k], fixed ? 0.0f : free_nodes[4 * i + k]);
    // The topmost held node lets soil fall that is packed less densely there than above it.
    const auto next = masses.find({at[0], at[1], at[2] + 1});
    const double share =
        reference::falling_share(mass, next == masses.end() ? 0 : next->second, above);
    const auto free_speed = static_cast<double>(free_nodes[4 * i + 2]);
    const double down = above == 0 ? std::min(free_speed, 0.0) * share : 0;
    EXPECT_NEAR(static_cast<double>(nodes[4 * i + 2]), fixed ? down : free_speed,
                1e-5 * std::abs(free_speed));
    falling += fixed && down < 0;
    // One float division more than without ground.
    EXPECT_NEAR(static_cast<double>(nodes[4 * i + 3]) * reference::free_fraction_above(above), mass,
                1e-6 * mass);
    held += mass > 0 && above <= kScheme.held_margin;
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(falling, 10);
}

TEST(GridUpdate, KeepsTheMassesOfTheFirstStepInLaterStepsOfATransfer) {
  const std::vector<Particle> particles = strewn(200);
  std::vector<std::vector<float>> later;
  for (const bool renew : {true, false}) {
    Stages stages(particles, 40);
    nodes_of(stages, Vec3::Zero());
    stages.near.renew = renew;
    stages.scatter.enqueue(stages.store, stages.report, kStageStep, kStageCell, true);
    stages.grid.enqueue(stages.store, stages.scatter, stages.near, Vec3(0, 0, -0.01), true);
    later.push_back(stages.grid.velocity().read());
    later.back().resize(4 * BLOCK_NODES * stages.store.table().active.size());
  }
  EXPECT_EQ(later[0], later[1]);
}

TEST(GridUpdate, DoesNothingWithoutBlocks) {
  Stages stages({});
  EXPECT_TRUE(nodes_of(stages, Vec3::Zero()).empty());
}

}  // namespace
}  // namespace navvy::soil
