// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/particle_to_grid.h"

#include <gtest/gtest.h>

#include "soil/particles/stages.h"

namespace navvy::soil {
namespace {

TEST(ParticleToGrid, KeepsMassAndMomentumForAnyNumberOfParticles) {
  // One, a pack less one, a pack and one, more than a chunk of the other schedule.
  for (const int count : {1, 15, 17, 413}) {
    const std::vector<Particle> particles = strewn(count);
    Stages stages(particles);
    stages.enqueue_scatter();
    const std::vector<float> tiles = stages.scatter.tiles().read();
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (const ParticleBlock& particle_block : stages.store.particle_blocks()) {
      const auto first =
          tiles.begin() + static_cast<std::ptrdiff_t>(particle_block.tile) * 4 * TILE_NODES;
      sum += sum_of(std::vector<float>(first, first + 4 * 512), 512);
    }
    // Stress and affine parts cancel in the sum; floats of 27 shares per particle, in units of 0.2
    // kg m/s each.
    const Eigen::Vector4d expected = sum_of(particles);
    EXPECT_LT((sum - expected).cwiseAbs().maxCoeff(), 1e-6 * 0.2 * count) << count;
    for (const Report& report : stages.report.map_read(0, stages.store.particle_blocks().size()))
      EXPECT_EQ(report.broken, 0);
  }
}

TEST(ParticleToGrid, ReportsTheBlockThatHoldsAValueThatIsNotFinite) {
  std::vector<Particle> particles = strewn(40);
  particles[3].j = std::nanf("");
  Stages stages(particles);
  stages.enqueue_scatter();
  int broken = 0;
  for (const Report& report : stages.report.map_read(0, stages.store.particle_blocks().size()))
    broken += report.broken;
  EXPECT_EQ(broken, 1);
}

TEST(ParticleToGrid, DoesNothingWithoutParticles) {
  Stages stages({});
  stages.enqueue_scatter();
  EXPECT_EQ(stages.store.count(), 0);
}

}  // namespace
}  // namespace navvy::soil
