// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/grid_update.h"

#include <gtest/gtest.h>

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

TEST(GridUpdate, HoldsNodesInTheGroundAndReportsMassPerFreeVolumeAboveIt) {
  // Ground through the middle of the scattered particles.
  const std::vector<Particle> particles = strewn(200);
  Stages open(particles), stages(particles, 40);
  const std::vector<float> free_nodes = nodes_of(open, Vec3::Zero()),
                           nodes = nodes_of(stages, Vec3::Zero());
  const BlockTable& table = stages.store.table();
  int held = 0;
  for (std::size_t i = 0; i < nodes.size() / 4; ++i) {
    const double above = kBlockCells * table.active[i / BLOCK_NODES].z +
                         static_cast<double>(i % BLOCK_NODES / 16) - 40;
    const auto mass = static_cast<double>(free_nodes[4 * i + 3]);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(nodes[4 * i + k], above <= kScheme.held_margin ? 0.0f : free_nodes[4 * i + k]);
    // One float division more than without ground.
    EXPECT_NEAR(static_cast<double>(nodes[4 * i + 3]) * reference::free_fraction_above(above), mass,
                1e-6 * mass);
    held += mass > 0 && above <= kScheme.held_margin;
  }
  EXPECT_GT(held, 10);
}

TEST(GridUpdate, DoesNothingWithoutBlocks) {
  Stages stages({});
  EXPECT_TRUE(nodes_of(stages, Vec3::Zero()).empty());
}

}  // namespace
}  // namespace navvy::soil
