// SPDX-License-Identifier: Apache-2.0
// A program releases a trailer; so does an input, which does not end the program.
#include <gtest/gtest.h>

#include "control/step_kinds.h"
#include "core/error.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::session {
namespace {

scene::Scene unhitch() {
  scene_io::Overrides overrides;
  overrides.render = false;
  return scene_io::load_scene(navvy::source_dir() + "/scenarios/paper/unhitch.sdf",
                              control::step_kinds(), overrides);
}

Vec3 place(const sim::World& world, const char* machine) {
  return world.machines().at(machine).link(0).pose().translation();
}

TEST(Unhitch, TheTrailerStaysWhereItsProgramReleasesIt) {
  device::Device device;
  Session session(unhitch(), device);
  const sim::World& world = session.world();
  Vec3 left = Vec3::Zero();
  double apart = 0;
  while (!session.done()) {
    session.step();
    if (!world.machines().hitch(0).closed) continue;
    left = place(world, "trailer");
    apart = std::max(apart, world.outputs().get("trailer/hitch/apart"));
  }
  EXPECT_TRUE(session.complete());
  // It was drawn to the place and rolled on by at most the length of its drawbar; the robot
  // returned.
  EXPECT_GT(left.x(), 0.5);
  EXPECT_LT((place(world, "trailer") - left).head<2>().norm(), 0.5);
  EXPECT_LT((place(world, "robot") - Vec3(-2.5, 2.5, 0)).head<2>().norm(), 0.3);
  EXPECT_LT(apart, 2e-3);
  EXPECT_EQ(world.outputs().get("trailer/hitch/closed"), 0);
  EXPECT_EQ(world.soil().mass_ledger().error, 0);
}

TEST(Unhitch, AnInputReleasesTheTrailerAndTheProgramContinues) {
  device::Device device;
  Session session(unhitch(), device);
  for (int i = 0; i < 300; ++i) session.step();
  session.set("trailer/hitch/closed", 0);
  EXPECT_EQ(session.world().outputs().get("trailer/hitch/closed"), 0);
  while (!session.done()) session.step();
  EXPECT_TRUE(session.complete());
  // Out of reach now: refused without effect.
  EXPECT_THROW(session.set("trailer/hitch/closed", 1), InputError);
  EXPECT_EQ(session.world().outputs().get("trailer/hitch/closed"), 0);
}

}  // namespace
}  // namespace navvy::session
