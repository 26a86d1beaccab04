// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <gtest/gtest.h>

namespace navvy::scene {
namespace {

TEST(Scene, FindsSoilsAndMachinesByNameAndAnswersMinusOneOtherwise) {
  Scene world;
  world.soils.resize(2);
  world.soils[0].name = "loam";
  world.soils[1].name = "sand";
  world.machines.resize(1);
  world.machines[0].name = "digger";
  EXPECT_EQ(world.soil_index("sand"), 1);
  EXPECT_EQ(world.soil_index("Sand"), -1);
  EXPECT_EQ(world.machine_index("digger"), 0);
  EXPECT_EQ(world.machine_index(""), -1);
}

TEST(Machine, FindsLinksAndJointsByName) {
  Machine machine;
  machine.links.resize(2);
  machine.links[1].name = "boom";
  machine.joints.resize(1);
  machine.joints[0].name = "boom_joint";
  EXPECT_EQ(machine.link_index("boom"), 1);
  EXPECT_EQ(machine.joint_index("boom_joint"), 0);
  EXPECT_EQ(machine.joint_index("boom"), -1);
}

// A scene that states nothing must be a sound one: the loader's defaults are these.
TEST(Scene, DefaultsAreSound) {
  const Scene world;
  EXPECT_GT(world.solver.cell, 0);
  EXPECT_LT(world.gravity.z(), 0);
  const Soil soil;
  EXPECT_LE(soil.residual_cohesion, soil.cohesion);
  EXPECT_GE(soil.swell, 1);
  EXPECT_LT(soil.poisson, 0.5);
  EXPECT_LE(soil.tool_friction_angle, soil.friction_angle);
}

}  // namespace
}  // namespace navvy::scene
