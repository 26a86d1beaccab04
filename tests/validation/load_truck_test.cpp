// SPDX-License-Identifier: Apache-2.0
// scenarios/load_truck.sdf from start to end: the bed holds the payloads of the buckets, and the
// heap the load of the bed.
#include <gtest/gtest.h>

#include <cmath>

#include "session/soil_mass.h"
#include "validation/loads.h"
#include "validation/report.h"
#include "validation/scenes.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "[docs/validation.md, Loading and hauling]";

TEST(LoadTruck, TheBedHoldsFivePayloadsAndTheHeapHoldsTheBed) {
  session::Session session(load_scene("load_truck.sdf"), shared_device());
  const sim::World& world = session.world();
  const int truck = world.description().machine_index("dumper");
  ASSERT_GE(truck, 0);
  // Position of the truck and load of its bed, before it drives off and after.
  double loaded = -1, from = 0, to = 0, fastest_rise = 0;
  std::size_t tips = 0;
  while (!session.done()) {
    session.step();
    fastest_rise =
        std::max(fastest_rise, std::abs(world.machines().at(truck).link(0).velocity().z()));
    if (loaded < 0 && session.cycles().size() == 5 && session.phase(truck) == "drive") {
      loaded = session::testing::carried(world, truck, "bed");
      from = world.machines().at(truck).link(0).pose().translation().x();
    }
    if (tips == 0 && session.phase(truck) == "tip") {
      tips = 1;
      to = world.machines().at(truck).link(0).pose().translation().x();
    }
  }
  double brought = 0;
  for (const session::Cycle& cycle : session.cycles()) brought += cycle.payload_dump;
  ASSERT_EQ(session.tips().size(), 2u);
  const double before_tip = session.tips()[0].payload_start;
  // The rear edge of the bed is 1.45 m behind the rear axle; the heap is within 4 m of it.
  const double heap = session::testing::mass_gained(world, Vec2(to - 5.5, -4), Vec2(to + 2.5, 4));
  expect_between("passes", static_cast<double>(session.cycles().size()), 5, 5, kSource);
  expect_between("sum of the payloads [kg]", brought, 3500, 5250, kSource);
  expect_between("mean payload of all cycles / heaped bucket",
                 mean_payload(session) / heaped_load(world.description()), 0.85, 1.1, kSource);
  expect_between("bed mass / sum of payloads", loaded / brought, 0.99, 1.01, kSource);
  expect_between("path of the truck [m]", to - from, 50, 51, kSource);
  expect_between("bed mass after the drive / before", before_tip / loaded, 0.99, 1.01, kSource);
  expect_between("heap / bed mass", heap / before_tip, 0.99, 1.01, kSource);
  expect_between("left in the bed [kg]", session::testing::carried(world, truck, "bed"), 0,
                 0.01 * before_tip, kSource);
  expect_between("ledger error [units]", static_cast<double>(world.soil().mass_ledger().error), 0,
                 0, kSource);
  expect_between("shell crossings", static_cast<double>(world.soil().counts().shell_crossings), 0,
                 0, kSource);
  expect_between("momentum residual / scale", session.force().residual_max, 0, 1e-5, kSource);
  expect_between("truck's vertical speed [m/s]", fastest_rise, 0, 1.0,
                 "a machine does not jump [docs/validation.md, Machines]");
  std::printf("%.0f s simulated, at most %d particles\n", world.time(),
              world.soil().counts().particles_peak);
}

}  // namespace
}  // namespace navvy::validation
