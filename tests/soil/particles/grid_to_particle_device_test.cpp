// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/grid_to_particle.h"

#include <gtest/gtest.h>

#include "soil/particles/stages.h"

namespace navvy::soil {
namespace {

TEST(GridToParticle, ReadsALinearVelocityFieldBackExactly) {
  // Quadratic weights reproduce linear fields: v(x) = v0 + G x with x in metres gives C = G.
  const Vec3 v0(0.3, -0.2, 0.1);
  Mat3 gradient;
  gradient << 1, -2, 0.5, 0.25, -1, 2, -0.5, 1.5, 0.75;
  for (const int count : {1, 16, 33}) {
    Stages stages(strewn(count));
    const BlockTable& table = stages.store.table();
    std::vector<float> nodes(stages.grid.velocity().size(), 0.0f);
    for (std::size_t i = 0; i < BLOCK_NODES * table.active.size(); ++i) {
      const BlockKey key = table.active[i / BLOCK_NODES];
      const int n = static_cast<int>(i % BLOCK_NODES);
      const Vec3 node(kBlockCells * key.x + (n & 3), kBlockCells * key.y + (n >> 2 & 3),
                      kBlockCells * key.z + (n >> 4));
      const Vec3 v = v0 + gradient * (kStageCell * (node - Vec3::Constant(40)));
      for (int k = 0; k < 3; ++k)
        nodes[4 * i + static_cast<std::size_t>(k)] = static_cast<float>(v[k]);
      // Loose: nothing separates.
      nodes[4 * i + 3] = 1e-3f;
    }
    stages.grid.velocity().write(nodes);
    stages.scatter.used().write(std::vector<std::int32_t>(table.particle_blocks.size(), 1));
    const std::vector<Particle> before = stages.store.records();
    stages.enqueue_gather();
    const std::vector<Particle> after = stages.store.records();
    double fastest = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      Vec3 x;
      for (int a = 0; a < 3; ++a)
        x[a] = kBlockCells * before[i].block[a] + static_cast<double>(before[i].x[a]);
      const Vec3 v = v0 + gradient * (kStageCell * (x - Vec3::Constant(40)));
      for (int a = 0; a < 3; ++a) {
        // Float sums over 27 nodes of speeds below 2 m/s; the gradient is their difference over a
        // cell.
        EXPECT_NEAR(static_cast<double>(after[i].v[a]), v[a], 2e-6);
        EXPECT_NEAR(static_cast<double>(after[i].x[a]),
                    static_cast<double>(before[i].x[a]) + kStageStep / kStageCell * v[a], 1e-6);
        for (int b = 0; b < 3; ++b)
          EXPECT_NEAR(static_cast<double>(after[i].c[3 * a + b]), gradient(a, b), 2e-4);
      }
      EXPECT_EQ(after[i].j, before[i].j);
      fastest = std::max(fastest, v.cwiseAbs().maxCoeff());
    }
    double reported = 0;
    for (const Report& report : stages.report.map_read(0, table.particle_blocks.size()))
      reported = std::max(reported, static_cast<double>(report.speed));
    EXPECT_NEAR(reported, fastest, 2e-6);
  }
}

// Nodes with more mass to the right: where that is crowded, sheared soil moves left and other soil
// stays.
TEST(GridToParticle, MovesCrowdedSoilApartByItsShear) {
  for (const double gradient : {0.0, 5.0, 1000.0}) {
    Stages stages(strewn(33));
    const BlockTable& table = stages.store.table();
    const double full = packed_mass(stages.store.densest(), kStageCell), slope = 0.02 * full;
    std::vector<float> nodes(stages.grid.velocity().size(), 0.0f);
    for (std::size_t i = 0; i < BLOCK_NODES * table.active.size(); ++i) {
      const BlockKey key = table.active[i / BLOCK_NODES];
      const int n = static_cast<int>(i % BLOCK_NODES);
      const double x = kBlockCells * key.x + (n & 3) - 40,
                   y = kBlockCells * key.y + (n >> 2 & 3) - 40;
      nodes[4 * i] = static_cast<float>(gradient * kStageCell * y);  // v_x(y)
      nodes[4 * i + 3] = static_cast<float>(1.2 * full + slope * x);
    }
    stages.grid.velocity().write(nodes);
    stages.scatter.used().write(std::vector<std::int32_t>(table.particle_blocks.size(), 1));
    const std::vector<Particle> before = stages.store.records();
    stages.enqueue_gather();
    const std::vector<Particle> after = stages.store.records();
    int crowded = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double x = kBlockCells * before[i].block[0] + static_cast<double>(before[i].x[0]) - 40;
      const double y = kBlockCells * before[i].block[1] + static_cast<double>(before[i].x[1]) - 40;
      // |D| of a simple shear is the gradient; the variance of the quadratic B-spline is a quarter
      // of a cell.
      const double mass = 1.2 * full + slope * x,
                   share = std::min(1.0, kStageStep * gradient / kScheme.crowding_strain);
      double apart =
          std::max(-share * 0.25 * slope / mass, -0.25 * kScheme.max_crowding_displacement);
      if (static_cast<double>(before[i].j) * mass <= full) apart = 0;
      crowded += apart < 0;
      const double displacement = kStageStep * gradient * y + apart;
      EXPECT_NEAR(static_cast<double>(after[i].x[0]) - static_cast<double>(before[i].x[0]),
                  displacement, 2e-6 * (1 + gradient));
      EXPECT_NEAR(static_cast<double>(after[i].x[2]), static_cast<double>(before[i].x[2]), 1e-6);
      // Open soil closes here, as these nodes are heavy; no J falls below the density state.
      EXPECT_LE(after[i].j, before[i].j);
      EXPECT_GE(after[i].j, std::min(before[i].j, before[i].j0));
    }
    EXPECT_EQ(crowded > 20, gradient > 0);
  }
}

// Where the nodes hold the mass of closed soil, soil that is a little open closes by its share.
// Soil that is far open has been thrown and keeps its gaps; light nodes change nothing.
TEST(GridToParticle, ClosesWhatNoiseOpensWhereTheNodesShowIt) {
  std::vector<Particle> soil = strewn(40);
  const float state = 1.1f, opened[] = {1.08f, 1.15f, 1.3f};
  for (std::size_t i = 0; i < soil.size(); ++i) soil[i].j0 = state, soil[i].j = opened[i % 3];
  // Of the mass of closed soil in this state.
  for (const double filled : {0.8, 1.0}) {
    Stages stages(soil);
    const BlockTable& table = stages.store.table();
    const double mass = 1.01 * filled * filled_mass(stages.store.densest(), kStageCell) /
                        static_cast<double>(state);
    std::vector<float> nodes(stages.grid.velocity().size(), 0.0f);
    for (std::size_t i = 3; i < nodes.size(); i += 4) nodes[i] = static_cast<float>(mass);
    stages.grid.velocity().write(nodes);
    stages.scatter.used().write(std::vector<std::int32_t>(table.particle_blocks.size(), 1));
    const std::vector<Particle> before = stages.store.records();
    stages.enqueue_gather();
    const std::vector<Particle> after = stages.store.records();
    int closed = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const bool closes = filled >= 1 && before[i].j == opened[1];
      closed += closes;
      // Stages pass a quarter of a transfer.
      const double displacement =
          closes ? 0.25 * kScheme.closing_share * static_cast<double>(opened[1] - state) : 0;
      EXPECT_NEAR(static_cast<double>(before[i].j - after[i].j), displacement, 1e-6);
      EXPECT_EQ(after[i].j0, before[i].j0);
    }
    EXPECT_EQ(closed > 0, filled >= 1);
  }
}

TEST(GridToParticle, DoesNothingWithoutParticles) {
  Stages stages({});
  stages.enqueue_gather();
  EXPECT_TRUE(stages.store.records().empty());
}

}  // namespace
}  // namespace navvy::soil
