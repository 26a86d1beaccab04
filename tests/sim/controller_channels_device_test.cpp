// SPDX-License-Identifier: Apache-2.0
// Channels of a controller: the same for a robot moved by kinematics and by forces, and levers and
// links of an excavator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "sim/scenes.h"
#include "sim/world.h"
#include "values.h"

namespace navvy::sim {
namespace {

std::vector<std::string> names(const std::vector<Channel>& channels) {
  std::vector<std::string> out;
  out.reserve(channels.size());
  for (const Channel& channel : channels) out.push_back(channel.name + " [" + channel.unit + "]");
  return out;
}

class ControllerChannels : public ::testing::Test {
 protected:
  device::Device device_;
};

TEST_F(ControllerChannels, HaveTheSameNamesInBothEngines) {
  World exact(testing::load("paper/diff_kinematic.sdf"), device_),
      rolling(testing::load("paper/diff_physics.sdf"), device_);
  EXPECT_TRUE(exact.description().machines[0].machine.kinematic);
  EXPECT_FALSE(rolling.description().machines[0].machine.kinematic);
  // Except for the six numbers, which the dynamic engine does not accept, and for the tipping state
  // of a machine with masses.
  const auto without = [](std::vector<std::string> list, const std::string& part,
                          std::size_t count) {
    const auto holds = [&](const std::string& name) {
      return name.find(part) != std::string::npos;
    };
    EXPECT_EQ(std::erase_if(list, holds), count);
    return list;
  };
  EXPECT_EQ(without(names(exact.inputs().channels()), "/pose/", 7),
            names(rolling.inputs().channels()));
  EXPECT_EQ(names(exact.outputs().channels()),
            without(names(rolling.outputs().channels()), "/stability/", 2));
  for (World* world : {&exact, &rolling}) {
    world->inputs().set("robot/spin_left/velocity", 4);
    world->inputs().set("robot/spin_right/velocity", 4);
    // At most half of the register: 0.43 of a turn.
    while (world->time() < 0.7) world->step();
    // 4 rad/s for 0.7 s, and up to 0.15 s for a motor's start.
    EXPECT_NEAR(world->outputs().get("robot/pose/x"), -3.5 + 0.1 * 4 * 0.7, 0.1 * 4 * 0.16);
    const double turns = world->outputs().get("robot/spin_left/position") / (2 * kPi);
    EXPECT_EQ(world->outputs().get("robot/spin_left/counts"),
              std::floor(std::fmod(turns * 76600, 65536)));
    EXPECT_EQ(static_cast<double>(world->machines().at("robot").joint("spin_left").counts()),
              world->outputs().get("robot/spin_left/counts"));
  }
  EXPECT_THROW(exact.machines().at("robot").joint("spin_ball").counts(), InputError);
}

TEST_F(ControllerChannels, AKinematicMachineFollowsItsCommandAndPushesSoil) {
  scene::Scene scene = testing::load("bucket_path.sdf");
  // Freed from the world with fixed slides: the whole machine is lowered into the soil and moves
  // ahead.
  scene.machines[0].machine.fixed_base = false;
  World world(scene, device_);
  const double before = world.outputs().get("bucket/pose/z");
  world.inputs().set("bucket/pose/duration", 0.5);
  world.inputs().set("bucket/pose/z", before - 0.45);
  while (world.time() < 0.6) world.step();
  EXPECT_NEAR(world.outputs().get("bucket/pose/z"), before - 0.45, 1e-9);
  world.inputs().set("bucket/pose/x", world.outputs().get("bucket/pose/x") + 0.2);
  while (world.time() < 0.9) world.step();
  EXPECT_NEAR(world.outputs().get("bucket/velocity/x"), 0.4, 1e-6);
  print_value("soil on a bucket that is pushed along [N]",
              world.outputs().get("bucket/bucket/smooth_force_x"), "< 0", "");
  EXPECT_LT(world.outputs().get("bucket/bucket/smooth_force_x"), -50);
  World forces(testing::load("paper/diff_physics.sdf"), device_);
  EXPECT_THROW(forces.commands().set(forces.machines().at("robot"), vehicle::BaseInput{}),
               InputError);
  vehicle::BaseInput far;
  far.p_W.x() = 1e9;
  EXPECT_THROW(world.commands().set(world.machines().at("bucket"), far), InputError);
}

/// Returns a block of 0.6 x 0.6 x 0.4 m, defined only by its visual.
std::string block(const std::string& name, const std::string& x, const std::string& about) {
  return "<model name=\"" + name + "\"><pose>" + x + " 0 0.2 0 0 0</pose>" + about +
         "<link name=\"block\"><navvy:density_kg_per_m3>2600</navvy:density_kg_per_m3><visual "
         "name=\"v\"><geometry>"
         "<box><size>0.6 0.6 0.4</size></box></geometry></visual></link></model>";
}

TEST_F(ControllerChannels, AKinematicBodyPushesALooseOne) {
  const scene::Scene scene = scene_io::load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil "
      "ref=\"loam\"/><navvy:ground>"
      "<size_m>12 8</size_m></navvy:ground>" +
          block("pushed", "0.8", "") +
          block("pusher", "0", "<navvy:physics>kinematic</navvy:physics>") + "</world></sdf>",
      "w.sdf", control::step_kinds());
  World whole(scene, device_), resumed(scene, device_);
  whole.inputs().set("pusher/pose/duration", 2);
  whole.inputs().set("pusher/pose/x", 1);
  while (whole.time() < 1) whole.step();
  EXPECT_NEAR(whole.outputs().get("pushed/pose/x"), 1.1, 0.01);
  load_saved(saved(whole), resumed);
  for (World* world : {&whole, &resumed})
    while (world->time() < 2.5) world->step();
  EXPECT_NEAR(whole.outputs().get("pushed/pose/x"), 1.6, 0.02);
  EXPECT_EQ(whole.hashes().state(), resumed.hashes().state());
}

TEST_F(ControllerChannels, EncodersAndTheirFaultsAreInHashAndSnapshot) {
  const scene::Scene scene = testing::load("paper/diff_kinematic.sdf");
  World whole(scene, device_), resumed(scene, device_), other(scene, device_);
  for (World* world : {&whole, &other}) {
    world->inputs().set("robot/drive/speed", 0.5);
    for (int i = 0; i < 50; ++i) world->step();
  }
  EXPECT_EQ(whole.hashes().state(), other.hashes().state());
  whole.inputs().set("robot/spin_left/encoder_missed", 0.1);
  EXPECT_NE(whole.hashes().state(), other.hashes().state());
  const auto parts = whole.hashes().parts();
  EXPECT_TRUE(std::any_of(parts.begin(), parts.end(),
                          [](const auto& part) { return part.first == "encoders"; }));
  load_saved(saved(whole), resumed);
  for (World* world : {&whole, &resumed, &other})
    for (int i = 0; i < 50; ++i) world->step();
  EXPECT_EQ(resumed.hashes().state(), whole.hashes().state());
  EXPECT_EQ(resumed.outputs().get("robot/spin_left/counts"),
            whole.outputs().get("robot/spin_left/counts"));
  EXPECT_LT(whole.outputs().get("robot/spin_left/counts"),
            other.outputs().get("robot/spin_left/counts"));
  EXPECT_EQ(whole.outputs().get("robot/spin_right/counts"),
            other.outputs().get("robot/spin_right/counts"));
  EXPECT_EQ(whole.outputs().get("robot/pose/x"), other.outputs().get("robot/pose/x"));
}

TEST_F(ControllerChannels, ReportShaftsAndAcceptGearsOfAPowerTrain) {
  World world(testing::load("paper/power_train.sdf"), device_);
  world.inputs().set("truck/drive/speed", 2);
  world.inputs().set("truck/drive/gear", 1);
  while (world.time() < 2.5) world.step();
  const auto get = [&](const char* name) {
    return world.outputs().get(std::string("truck/") + name);
  };
  EXPECT_EQ(get("engine/gear"), 1);
  EXPECT_GT(get("engine/speed"), 1000 * kPi / 30);
  EXPECT_NEAR(get("engine/speed"), 3.4 * 11.5 * get("axle_1/speed"), 0.02 * get("engine/speed"));
  EXPECT_NEAR(get("engine/power"), get("engine/speed") * get("engine/torque"),
              1e-6 * get("engine/power"));
  EXPECT_NEAR(get("axle_1/speed"), 0.5 * (get("spin_rear_left/spin") + get("spin_rear_right/spin")),
              1e-12);
  EXPECT_NEAR(get("axle_1/torque"),
              get("spin_rear_left/shaft_torque") + get("spin_rear_right/shaft_torque"), 1e-9);
  for (const double gear : {-1.0, 1.5, 4.0, 1e9})
    EXPECT_THROW(world.inputs().set("truck/drive/gear", gear), InputError) << gear;
  World other(testing::load("trench.sdf"), device_);
  EXPECT_THROW(other.outputs().get("excavator/engine/speed"), InputError);
  EXPECT_THROW(
      other.commands().set(other.machines().at("excavator"), vehicle::DriveInput{1, 0, false, 1}),
      InputError);
}

TEST_F(ControllerChannels, LeversMoveTheArmByTheMachinesControlPattern) {
  for (const bool sae : {false, true}) {
    SCOPED_TRACE(sae ? "SAE" : "ISO");
    scene::Scene scene = testing::load("trench.sdf");
    if (sae) scene.machines[0].machine.levers.pattern = scene::Levers::Pattern::kSae;
    World world(std::move(scene), device_);
    const auto rate = [&](const char* joint) {
      return world.outputs().get(std::string("excavator/") + joint + "/velocity");
    };
    world.inputs().set("excavator/levers/left_y", -1);     // towards the operator
    world.inputs().set("excavator/levers/right_y", 0.04);  // within the dead band
    world.inputs().set("excavator/levers/left_x", -1);     // to the left
    for (int i = 0; i < 200; ++i) world.step();
    // ISO retracts the stick, SAE raises the boom; the other one is held.
    if (sae) EXPECT_GT(rate("boom_joint"), 0.05);
    if (!sae) EXPECT_LT(rate("arm_joint"), -0.05);
    EXPECT_NEAR(rate(sae ? "arm_joint" : "boom_joint"), 0, 0.02);
    EXPECT_GT(rate("swing_joint"), 0.2);
  }
}

TEST_F(ControllerChannels, LeversBeyondTheirBoundsAreRefused) {
  World world(testing::load("trench.sdf"), device_);
  const sim::Inputs& inputs = world.inputs();
  const Channel& lever = inputs[static_cast<std::size_t>(inputs.index("excavator/levers/left_y"))];
  EXPECT_EQ(lever.low, -1);
  EXPECT_EQ(lever.high, 1);
  try {
    world.inputs().set(lever.name, 55);
    FAIL() << "a lever of 55 was taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "error: excavator/levers/left_y: '55': must be from -1 to 1 (unit 1) (send a "
                 "value within the bounds of the input)");
  }
  world.inputs().set(lever.name, 1 + 1e-9);
  // A joint uses its limit instead, and says so in the log.
  const int boom = inputs.index("excavator/boom_joint/position");
  EXPECT_TRUE(inputs[static_cast<std::size_t>(boom)].clamped);
  EXPECT_LT(inputs[static_cast<std::size_t>(boom)].high, 10);
  world.inputs().set(boom, 1000);
}

TEST_F(ControllerChannels, BrakesHoldJointsUntilReleased) {
  World world(testing::load("trench.sdf"), device_);
  const auto get = [&](const char* name) {
    return world.outputs().get(std::string("excavator/") + name);
  };
  world.inputs().set("excavator/swing_joint/brake", 1);
  world.inputs().set("excavator/levers/left_x", -1);
  world.inputs().set("excavator/front_axle_oscillation/brake", 1);
  for (int i = 0; i < 200; ++i) world.step();
  EXPECT_EQ(get("swing_joint/brake"), 1);
  EXPECT_NEAR(get("swing_joint/position"), 0, 1e-3);
  world.inputs().set("excavator/drive/speed", 0.5);  // the lock does not affect the drive
  for (int i = 0; i < 200; ++i) world.step();
  EXPECT_EQ(get("front_axle_oscillation/brake"), 1);
  world.inputs().set("excavator/swing_joint/brake", 0);
  for (int i = 0; i < 200; ++i) world.step();
  EXPECT_EQ(get("swing_joint/brake"), 0);
  EXPECT_GT(get("swing_joint/velocity"), 0.2);
  EXPECT_THROW(world.inputs().set("excavator/boom_joint/brake", 1), InputError);
  EXPECT_THROW(
      world.commands().set_brake(world.machines().at("excavator").joint("boom_joint"), true),
      InputError);
  // Tipping state of the same machine.
  EXPECT_GT(get("stability/tipping_load"), 500);
  // It drives and swings: inertia counts.
  EXPECT_GT(get("stability/loaded_margin"), 0.3);
  EXPECT_LT(get("stability/loaded_margin"), 1.3);
}

TEST_F(ControllerChannels, OfACrawlerEqualThoseOfADifferentialDrive) {
  World world(testing::load("paper/tracks.sdf"), device_);
  World wheeled(testing::load("paper/diff_physics.sdf"), device_);
  for (const char* name : {"drive/speed", "drive/steer", "drive/brake"}) {
    EXPECT_NO_THROW(world.inputs().index(std::string("crawler/") + name));
    EXPECT_NO_THROW(wheeled.inputs().index(std::string("robot/") + name));
  }
  world.inputs().set("robot/drive/speed", 0.4);
  world.inputs().set("crawler/drive/speed", 0);
  world.inputs().set("crawler/drive/steer", 0.3);
  while (world.time() < 3) world.step();
  EXPECT_NEAR(world.outputs().get("robot/velocity/x"), 0.4, 0.03);
  EXPECT_GT(world.outputs().get("robot/drive_left/counts"), 0);
  EXPECT_LT(world.outputs().get("crawler/drive_left/spin"), 0);
  EXPECT_GT(world.outputs().get("crawler/drive_right/spin"), 0);
  EXPECT_GT(world.outputs().get("crawler/pose/yaw"), 0.05);
  EXPECT_GT(world.outputs().get("crawler/drive_left/load"), 50e3);
  // One hash covers ruts, shear and tracks, which are part of the state.
  World other(testing::load("paper/tracks.sdf"), device_);
  load_saved(saved(world), other);
  EXPECT_EQ(hash_of(other).digest(), hash_of(world).digest());
  for (World* one : {&world, &other})
    for (int i = 0; i < 100; ++i) one->step();
  EXPECT_EQ(hash_of(other).digest(), hash_of(world).digest());
}

TEST_F(ControllerChannels, WatchAnyLinkByItsName) {
  World world(testing::load("trench.sdf"), device_);
  const std::size_t before = world.outputs().size();
  world.watch("excavator/stick");
  ASSERT_EQ(world.outputs().size(), before + 12);
  world.watch("excavator/stick");
  EXPECT_EQ(world.outputs().size(), before + 12);
  world.inputs().set("excavator/levers/left_x", 0.5);
  for (int i = 0; i < 100; ++i) world.step();
  const LinkHandle stick = world.machines().at("excavator").link("stick");
  EXPECT_EQ(world.outputs().get("excavator/stick/pose/z"), stick.pose().translation().z());
  EXPECT_EQ(world.outputs().get("excavator/stick/velocity/y"), stick.velocity().y());
  EXPECT_EQ(world.outputs().get("excavator/stick/angular_velocity/z"),
            stick.angular_velocity().z());
  EXPECT_GT(std::abs(world.outputs().get("excavator/stick/angular_velocity/z")), 0.05);
  // The tip moves as the bucket does.
  const double y = world.outputs().get("excavator/bucket/tip_y");
  world.step();
  EXPECT_NEAR((world.outputs().get("excavator/bucket/tip_y") - y) / world.dt(),
              world.outputs().get("excavator/bucket/tip_velocity_y"), 0.02);
  for (const char* name : {"excavator", "excavator/stik", "digger/stick"})
    EXPECT_THROW(world.watch(name), InputError) << name;
}

}  // namespace
}  // namespace navvy::sim
