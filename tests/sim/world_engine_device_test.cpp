// SPDX-License-Identifier: Apache-2.0
// The physics engine of a world comes from the caller's factory.
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "device/device.h"
#include "sim/scenes.h"
#include "sim/world.h"
#include "vehicle/physics_engine.h"

namespace navvy::sim {
namespace {

TEST(WorldEngine, ComesFromTheFactoryOfTheCaller) {
  device::Device device;
  int made = 0;
  Vec3 given = Vec3::Zero();
  const auto make = [&](const Vec3& gravity, const scene::Materials& materials) {
    ++made;
    given = gravity;
    return vehicle::make_bullet_engine(gravity, materials);
  };
  World own(testing::load("bucket_path.sdf"), device, make);
  World usual(testing::load("bucket_path.sdf"), device);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(given, own.description().gravity);
  EXPECT_EQ(own.hashes().state(), usual.hashes().state());
}

TEST(WorldEngine, RefusesAFactoryThatReturnsNone) {
  device::Device device;
  const auto make_nothing = [](const Vec3&, const scene::Materials&) {
    return std::unique_ptr<vehicle::PhysicsEngine>();
  };
  try {
    const World world(testing::load("bucket_path.sdf"), device, make_nothing);
    FAIL() << "a world without an engine was built";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the factory must return an engine"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace navvy::sim
