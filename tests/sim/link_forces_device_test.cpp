// SPDX-License-Identifier: Apache-2.0
// Forces from outside on links: found by name, zero until set, part of hash and snapshot.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "folder.h"
#include "sim/scenes.h"
#include "sim/world.h"

namespace navvy::sim {
namespace {

/// Returns a scene with a ball of 20 kg that hangs on a hinge at the origin of its link, 3 m above
/// the ground. Its link has `input` inside.
scene::Scene pendulum(const std::string& input) {
  const test::Folder folder;
  std::ofstream(folder / "pendulum.sdf")
      << "<sdf version='1.9' xmlns:navvy='navvy'><world name='w'><navvy:soil ref='gravel'/>"
         "<navvy:ground><size_m>6 6</size_m></navvy:ground><model name='post'>"
         "<navvy:on_ground>false</navvy:on_ground>"
         "<link name='base'><inertial><mass>9</mass></inertial></link>"
         "<link name='ball'><pose>0 0 3 0 0 0</pose><inertial><pose>0 0 -1 0 0 0</pose>"
         "<mass>20</mass></inertial>"
      << input
      << "</link><joint name='held' type='fixed'><parent>world</parent><child>base</child></joint>"
         "<joint name='hinge' type='revolute'><parent>base</parent><child>ball</child>"
         "<axis><xyz>0 -1 0</xyz><dynamics><damping>40</damping></dynamics></axis>"
         "<navvy:passive>true</navvy:passive></joint></model></world></sdf>";
  scene_io::Overrides overrides;
  overrides.render = false;
  return scene_io::load_scene(folder / "pendulum.sdf", control::step_kinds(), overrides);
}

void run(World& world, double duration) {
  const double end = world.time() + duration;
  while (world.time() < end) world.step();
}

TEST(LinkForces, HoldAPendulumAsideByName) {
  device::Device device;
  World world(pendulum("<navvy:force_input/>"), device);
  const int input = world.inputs().index("post/ball/external_force_x");
  world.inputs().set(input, 50);
  run(world, 8);
  const double angle = world.machines().at("post").joint("hinge").position();
  // At the centre of mass: tan = force over weight.
  EXPECT_NEAR(std::abs(angle), std::atan2(50, 20 * kGravity), 1e-3);
  // It acts until it is set again.
  world.inputs().set(input, 0);
  run(world, 8);
  EXPECT_NEAR(world.machines().at("post").joint("hinge").position(), 0, 1e-3);
}

TEST(LinkForces, ActOnTheirPoint) {
  device::Device device;
  World world(pendulum("<navvy:force_input><point_m>0 0 -2</point_m></navvy:force_input>"), device);
  world.inputs().set("post/ball/external_force_x", 50);
  run(world, 8);
  // With twice the lever arm of the weight.
  EXPECT_NEAR(std::abs(world.machines().at("post").joint("hinge").position()),
              std::atan2(2 * 50, 20 * kGravity), 1e-3);
}

TEST(LinkForces, AreInHashAndSnapshot) {
  device::Device device;
  World world(pendulum("<navvy:force_input/>"), device);
  run(world, 0.1);
  const std::string before = world.hashes().state();
  world.inputs().set("post/ball/external_force_z", 120);
  EXPECT_NE(world.hashes().state(), before);
  World resumed(pendulum("<navvy:force_input/>"), device);
  load_saved(saved(world), resumed);
  EXPECT_EQ(resumed.hashes().state(), world.hashes().state());
  run(world, 0.5);
  run(resumed, 0.5);
  EXPECT_EQ(resumed.hashes().state(), world.hashes().state());
}

TEST(LinkForces, AreOffByDefault) {
  device::Device device;
  World world(pendulum(""), device);
  EXPECT_EQ(world.inputs().find("post/ball/external_force_x"), -1);
  EXPECT_THROW(world.commands().set_force(world.machines().at("post"), 1, Vec3(1, 0, 0)),
               InputError);
}

}  // namespace
}  // namespace navvy::sim
