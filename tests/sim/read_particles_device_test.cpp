// SPDX-License-Identifier: Apache-2.0
#include "sim/read_particles.h"

#include <gtest/gtest.h>

#include <numeric>

#include "device/device.h"
#include "sim/scenes.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

TEST(ReadParticles, HaveTheValuesOfTheSolverAndTheMassOfTheLedger) {
  device::Device device;
  World world(testing::load("bucket_path.sdf"), device);
  EXPECT_EQ(read_particles(world).count(), 0u);
  const JointHandle slide = world.machines().at("bucket").joint("slide_z");
  world.commands().set(slide, {vehicle::JointMode::kVelocity, -0.4});
  while (world.soil().counts().particles < 200 && world.time() < 3) world.step();
  for (int i = 0; i < 20; ++i) world.step();
  const scene::ParticleTable table = read_particles(world);
  ASSERT_GT(table.count(), 100u);
  EXPECT_EQ(table.count(), static_cast<std::size_t>(world.soil().counts().particles));
  EXPECT_EQ(table.steps, world.steps());
  EXPECT_EQ(table.time, world.time());
  ASSERT_EQ(table.soils.size(), 1u);
  EXPECT_EQ(table.soils[0].name, world.description().soils[0].name);
  // Sums of multiples of 2^-24 kg are exact in doubles.
  EXPECT_EQ(std::accumulate(table.mass.begin(), table.mass.end(), 0.0),
            kilograms(world.soil().mass_ledger().particles[0]));
  const std::vector<soil::Particle> all = parts(world).soil.particles();
  const scene::Soil& soil = world.description().soils[0];
  const double bulk = soil.young_modulus / (3 * (1 - 2 * soil.poisson));
  std::size_t pressed = 0, open = 0;
  for (std::size_t i = 0; i < table.count(); ++i) {
    const soil::Particle& p = all[i];
    for (std::size_t a = 0; a < 3; ++a) {
      const double in_cells = p.block[a] * soil::kBlockCells + static_cast<double>(p.x[a]);
      ASSERT_EQ(table.position[3 * i + a], parts(world).soil.grid_origin()[static_cast<int>(a)] +
                                               in_cells * world.ground().cell());
      ASSERT_EQ(table.velocity[3 * i + a], p.v[a]);
      for (std::size_t b = 0; b < 3; ++b)
        ASSERT_EQ(table.velocity_gradient[9 * i + 3 * a + b], p.c[3 * a + b]);
    }
    ASSERT_EQ(table.id[i], p.id);
    ASSERT_EQ(table.soil[i], p.soil);
    ASSERT_EQ(table.mass[i], kilograms(p.mass));
    ASSERT_EQ(table.volume_ratio[i], p.j);
    ASSERT_EQ(table.density_state[i], p.j0);
    ASSERT_EQ(table.plastic_shear[i], p.shear);
    ASSERT_EQ(table.density[i], static_cast<float>(soil.bank_density / static_cast<double>(p.j)));
    // The deviator has no trace beyond the rounding of floats: the mean stress is the pressure.
    const double pressure =
        -(static_cast<double>(table.stress[6 * i]) + static_cast<double>(table.stress[6 * i + 1]) +
          static_cast<double>(table.stress[6 * i + 2])) /
        3;
    const double closed = 1 - static_cast<double>(p.j) / static_cast<double>(p.j0);
    // Floats of 10 kPa are exact to 1e-3 Pa; stress tensors gather such errors over the steps.
    ASSERT_NEAR(pressure, closed > 0 ? bulk * closed : 0, 1 + 1e-3 * std::abs(pressure));
    ASSERT_EQ(table.stress[6 * i + 3], p.s[3]);
    (closed > 0 ? pressed : open) += 1;
  }
  EXPECT_GT(pressed, 10u);
  EXPECT_GT(open, 0u);
}

}  // namespace
}  // namespace navvy::sim
