// SPDX-License-Identifier: Apache-2.0
// A loaded dumper drives, tips, moves away and lowers its bed: short version of
// scenarios/load_truck.sdf.
#include <gtest/gtest.h>

#include <cmath>

#include "control/step_kinds.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"
#include "session/soil_mass.h"

namespace navvy::session {
namespace {

constexpr double kLoad = 2000;  // [kg]

/// Returns haul.sdf with a shorter path, a lighter load and coarser soil.
scene::Scene short_haul() {
  scene_io::Overrides overrides;
  overrides.render = false;
  for (const char* setting : {"solver.cell_m=0.2", "machine[dumper].load.mass_kg=2000",
                              "machine[dumper].program.drive_to[1].target_m=-8 0",
                              "machine[dumper].program.drive_to[2].target_m=-4 0"})
    overrides.set.push_back(scene_io::parse_setting(setting));
  return scene_io::load_scene(navvy::source_dir() + "/scenarios/haul.sdf", control::step_kinds(),
                              overrides);
}

TEST(Haul, TheBedCarriesItsLoadAndTipsItOntoOneHeap) {
  device::Device device;
  Session session(short_haul(), device);
  const sim::World& world = session.world();
  const double start_x = world.machines().at(0).link(0).pose().translation().x();
  EXPECT_NEAR(testing::carried(world, 0, "bed"), kLoad, 1e-3);
  double rise = 0;
  while (!session.done()) {
    session.step();
    rise = std::max(rise, std::abs(world.machines().at(0).link(0).velocity().z()));
  }
  ASSERT_EQ(session.tips().size(), 2u);
  const BedTip& tip = session.tips()[0];
  std::printf("in the bed before tipping %.1f kg, after lowering %.1f kg\n", tip.payload_start,
              testing::carried(world, 0, "bed"));
  EXPECT_NEAR(tip.payload_start, kLoad, 0.01 * kLoad);
  EXPECT_LT(testing::carried(world, 0, "bed"), 0.01 * kLoad);
  const double heap = testing::mass_gained(world, Vec2(-13, -3), Vec2(-6, 3));
  std::printf("heap %.1f kg\n", heap);
  EXPECT_NEAR(heap, tip.payload_start, 0.01 * kLoad);
  EXPECT_GT(world.machines().at(0).link(0).pose().translation().x() - start_x, 6.8);
  EXPECT_LT(rise, 1.0);
  EXPECT_EQ(world.soil().mass_ledger().error, 0);
  EXPECT_EQ(world.soil().counts().shell_crossings, 0u);
}

}  // namespace
}  // namespace navvy::session
