// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "device/device.h"
#include "particle_engine.h"
#include "sim/world.h"
#include "vehicle/physics_engine.h"

namespace {

using namespace navvy;

/// Returns a scene with a cube of 1 m and 100 kg, 0.5 m above the ground.
scene::Scene falling_cube() {
  scene::Scene scene;
  scene.name = "falling_cube";
  scene.ground.size = Vec2(4, 4);
  scene.ground.origin = Vec2(-2, -2);
  scene.ground.depth = 1;
  scene.soils.push_back({});
  scene.ground.layers.push_back({scene.soils[0].name, 0});
  scene::MachineInWorld cube;
  cube.name = "cube";
  cube.X_WM = make_pose(0, 0, 1);
  cube.machine.links.push_back({});
  cube.machine.links[0].mass = 100;
  cube.machine.links[0].collisions.push_back({});
  scene.machines.push_back(cube);
  return scene;
}

TEST(WorldWithCustomEngine, LetsTheCubeFallOntoTheGround) {
  device::Device device;
  sim::World world(falling_cube(), device, example::make_particle_engine);
  const sim::LinkHandle cube = world.machines().at("cube").link(0);
  const double start = cube.pose().translation().z();
  while (world.time() < 1) world.step();
  EXPECT_NEAR(cube.pose().translation().z(), start - 0.5, 0.01);
  EXPECT_LT(cube.velocity().norm(), 0.05);
}

}  // namespace
