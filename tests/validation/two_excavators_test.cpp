// SPDX-License-Identifier: Apache-2.0
// scenarios/two_excavators.sdf from start to end: two machines dig side by side in one soil.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "record/summary.h"
#include "validation/report.h"
#include "validation/scenes.h"
#include "values.h"

namespace navvy::validation {
namespace {

TEST(TwoExcavators, DigSideBySideToTheEnd) {
  const char* source = "two machines in one soil [docs/validation.md, Whole digs]";
  session::Session session(load_scene("two_excavators.sdf"), shared_device());
  const sim::World& world = session.world();
  double fastest_rise = 0;
  while (!session.done()) {
    session.step();
    for (int m = 0; m < 2; ++m)
      fastest_rise =
          std::max(fastest_rise, std::abs(world.machines().at(m).link(0).velocity().z()));
  }
  std::array<double, 2> cycles{};
  double worst_loss = 0;
  for (const session::Cycle& cycle : session.cycles()) {
    cycles.at(static_cast<std::size_t>(cycle.machine)) += 1;
    if (cycle.payload_lift_out > 50)
      worst_loss = std::max(worst_loss, std::abs(cycle.payload_dump / cycle.payload_lift_out - 1));
  }
  expect_between("cycles of the first", cycles[0], 3, 60, source);
  expect_between("cycles of the second", cycles[1], 3, 60, source);
  expect_between("bank volume [m3]", record::measure_earthwork(world).bank_volume, 2, 20, source);
  expect_between("simulated [s]", world.time(), 1, world.description().recording.duration - 1,
                 "ends by itself");
  print_value("payload change, lift-out to dump", worst_loss, "no tolerance",
              "heaped buckets shed into the trench while they rise");
  expect_between("machines' vertical speed [m/s]", fastest_rise, 0, 1.0,
                 "a machine does not jump [docs/validation.md, Machines]");
  expect_between("ledger error [units]", static_cast<double>(world.soil().mass_ledger().error), 0,
                 0, source);
  expect_between("shell crossings", static_cast<double>(world.soil().counts().shell_crossings), 0,
                 0, source);
  expect_between("momentum residual / scale", session.force().residual_max, 0, 1e-5, source);
}

}  // namespace
}  // namespace navvy::validation
