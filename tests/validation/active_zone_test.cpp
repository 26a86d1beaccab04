// SPDX-License-Identifier: Apache-2.0
// The size of the active zone must not affect forces: a bucket on a prescribed path with the usual
// zone, and with a zone twice as large around and below.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "validation/report.h"
#include "validation/scenes.h"
#include "values.h"

namespace navvy::validation {
namespace {

struct Drag {
  double force = 0;  ///< mean over the drag, against its motion [N]
  /// Payload when the bucket is raised [kg].
  double payload = 0;
  /// Particle-steps up to then.
  std::uint64_t particle_steps = 0;
};

Drag drag(const std::string& zone) {
  session::Session session(load_scene("bucket_path.sdf", {"solver.active_zone=" + zone}),
                           shared_device());
  const sim::World& world = session.world();
  const sim::ToolHandle tool = world.machines().tools().at(0);
  Drag out;
  int samples = 0;
  while (world.time() < 6.7) {
    session.step();
    // The path drags from 1.7 to 3.7 s; the first half second fills the wedge ahead.
    if (world.time() < 2.2 || world.time() > 3.7) continue;
    out.force -= tool.force().x();
    ++samples;
  }
  out.force /= samples;
  out.payload = tool.payload();
  out.particle_steps = world.soil().counts().particle_steps;
  EXPECT_EQ(world.soil().mass_ledger().error, 0);
  return out;
}

TEST(ActiveZone, DoublingItChangesTheForceByLessThanTwoPercent) {
  const Drag usual = drag("1"), twice = drag("2");
  const char* source =
      "the active zone has no effect [docs/validation.md, Buckets and carried loads]";
  print_value("mean draft of the drag [N]", usual.force, "no tolerance", source);
  expect_between("mean draft, zone twice as large / as usual", twice.force / usual.force, 0.98,
                 1.02, source);
  expect_between("load, zone twice as large / as usual", twice.payload / usual.payload, 0.98, 1.02,
                 source);
  print_value("particle-steps, zone twice as large / as usual",
              static_cast<double>(twice.particle_steps) / static_cast<double>(usual.particle_steps),
              "the cost", source);
}

}  // namespace
}  // namespace navvy::validation
