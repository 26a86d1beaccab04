// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/mass_count.h"

#include <gtest/gtest.h>

#include "soil/rig.h"

namespace navvy::soil {
namespace {

TEST(MassCount, OnTheDeviceIsThatOnTheHostToTheUnitForEverySoil) {
  scene::Soil sand = rig::sand(), clay = rig::sand();
  clay.name = "clay";
  clay.bank_density = 2000;
  const std::vector<scene::Soil> soils = {sand, clay};
  rig::Rig site(soils);
  std::vector<Particle> particles = site.fill({Vec3(9, 9, 0.1), Vec3(10.3, 9.9, 0.6)});
  for (std::size_t i = 0; i < particles.size(); i += 3) {
    particles[i].soil = 1;
    // Every sum differs.
    particles[i].mass += static_cast<std::int32_t>(i);
  }
  ParticleStore store(rig::Rig::device(), {200, 200}, soil_table(soils, 0.1));
  store.assign(particles);
  MassCount count(rig::Rig::device(), soils.size());
  EXPECT_EQ(count.take(), (std::vector<std::int64_t>{0, 0}));
  count.queue(store);
  const std::vector<std::int64_t> host = store.masses(soils.size());
  EXPECT_EQ(count.take(), host);
  EXPECT_GT(host[0], 0);
  EXPECT_GT(host[1], 0);
}

}  // namespace
}  // namespace navvy::soil
