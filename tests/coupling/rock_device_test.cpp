// SPDX-License-Identifier: Apache-2.0
// A thin layer of soil over rock: the shipped excavator presses its bucket through it.
#include <gtest/gtest.h>

#include <algorithm>

#include "control/step_kinds.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "sim/world.h"
#include "values.h"

namespace navvy::coupling {
namespace {

/// A layer of less than two cells: one of four carries the front of the machine by itself [m].
constexpr double kDepth = 0.15;

TEST(Rock, ABucketPressedThroughTheSoilRestsOnItAndLiftsTheMachine) {
  scene::Scene scene =
      scene_io::load_scene(navvy::source_dir() + "/scenarios/trench.sdf", control::step_kinds());
  scene.ground.depth = kDepth;
  scene.machines.at(0).program = {};
  device::Device device;
  sim::World world(scene, device);
  const scene::Machine& machine = world.description().machines.at(0).machine;
  const int boom = machine.joint_index(machine.arm.boom),
            bucket = machine.link_index(machine.buckets.at(0).link);
  world.commands().set(world.machines().at(0).joint(boom), {vehicle::JointMode::kVelocity, -0.25});
  double lowest = 1, most = 0;
  while (world.time() < 6) {
    world.step();
    for (const Vec3& v : machine.shells.at(0).vertices)
      lowest = std::min(lowest, (world.machines().at(0).link(bucket).pose() * v).z());
    most = std::max(most, world.machines().tools().at(0).rock_force().z());
  }
  print_value("bucket below the surface of the rock [mm]", 1e3 * (-kDepth - lowest), "<= 10",
              "vehicle/bullet/rock.h");
  print_value("rock on the bucket [N]", most, "> 10e3: lifts the front wheels", "test");
  EXPECT_LT(lowest, 0.05 - kDepth) << "it went through the soil";
  EXPECT_GT(lowest, -0.01 - kDepth);
  EXPECT_GT(most, 10e3);
  EXPECT_GT(world.machines().at(0).link(0).pose().linear()(2, 0), 0.01) << "nose up";
  EXPECT_EQ(world.soil().mass_ledger().error, 0);
}

}  // namespace
}  // namespace navvy::coupling
