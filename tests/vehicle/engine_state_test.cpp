// SPDX-License-Identifier: Apache-2.0
// State that an engine saves between two steps: no more than it hashes, and no less than the next
// step needs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "core/error.h"
#include "core/saved_state.h"
#include "flip_bytes.h"
#include "vehicle/drive/drive_line.h"
#include "vehicle/joint_servo.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::digest;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;

std::unique_ptr<PhysicsEngine> engine_of(const std::string& name) {
  return name == "Bullet" ? make_bullet_engine(Vec3(0, 0, -kGravity)) : make_kinematic_engine();
}

class CombustionEngineState : public ::testing::TestWithParam<std::string> {
 protected:
  /// Builds the shipped excavator beside a robot: cylinders, pump, shells and both kinds of drive.
  std::unique_ptr<PhysicsEngine> build() const {
    auto engine = engine_of(GetParam());
    engine->add_machine(testing::ew180(), Pose::Identity());
    engine->add_machine(testing::robot(), make_pose(0, 6, 0));
    if (RockCapability* rock = engine->rock()) rock->set_rock(-0.5);
    return engine;
  }
};

TEST_P(CombustionEngineState, HashesEveryByteItSavesAndRefusesEveryByteOfAnotherScene) {
  const auto engine = build(), target = build();
  engine->set_drive(0, {0.8, 0.2, false});
  engine->set_joint(0, testing::ew180().joint_index("boom_joint"), {JointMode::kVelocity, -0.2});
  run(*engine, flat(), 0.2, kStep);
  engine->add_force(1, 0, Vec3(1, 2, 3), Vec3(0, 6, 0.2));
  EXPECT_EQ(test::flip_every_byte(*engine, *target), "");
}

TEST_P(CombustionEngineState, HoldsAForceThatActsInTheNextStepOnly) {
  const auto engine = build(), resumed = build();
  run(*engine, flat(), 0.1, kStep);
  const std::uint64_t before = digest(*engine);
  engine->add_force(1, 0, Vec3(0, 0, 20), Vec3(0, 6, 0.2));
  // A kinematic engine ignores forces.
  EXPECT_EQ(digest(*engine) == before, GetParam() == "Kinematic");
  load_saved(saved(*engine), *resumed);
  for (PhysicsEngine* each : {engine.get(), resumed.get()}) each->step(kStep, flat());
  EXPECT_EQ(digest(*resumed), digest(*engine));
}

TEST_P(CombustionEngineState, IsRefusedByOtherMachines) {
  const std::vector<char> bytes = saved(*build());
  auto fewer = engine_of(GetParam());
  fewer->add_machine(testing::ew180(), Pose::Identity());
  EXPECT_THROW(load_saved(bytes, *fewer), InputError);
  auto other = engine_of(GetParam());
  other->add_machine(testing::ew180(), Pose::Identity());
  other->add_machine(testing::cart(), Pose::Identity());
  EXPECT_THROW(load_saved(bytes, *other), InputError);
}

TEST_P(CombustionEngineState, WithoutAFinitePlaceIsRefusedByName) {
  const auto engine = build();
  for (const double place : {std::numeric_limits<double>::quiet_NaN(), 1e8}) {
    ByteMap map;
    std::vector<char> bytes = saved(*engine, &map);
    // Position of the base: the first numbers of one engine, the last of a pose in the other.
    for (const ByteMap::Field& field : map.fields) {
      const bool tree =
          field.path == "bullet[1]/tree/coordinates" && field.size > sizeof(std::uint64_t);
      if (!tree && field.path != "kinematic[1]/X_WB") continue;
      std::memcpy(bytes.data() + field.offset + (tree ? 0 : field.size - sizeof place), &place,
                  sizeof place);
    }
    try {
      load_saved(bytes, *engine);
      FAIL() << "a machine was loaded at " << place;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("[1]"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("finite"), std::string::npos) << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, CombustionEngineState, ::testing::Values("Bullet", "Kinematic"),
                         [](const auto& each) { return each.param; });

/// The drive brakes a wheel whose servo followed a command before: on a slope that servo counts how
/// long it is stuck, by its former limits.
TEST(BulletState, ResumesEqualAfterTheDriveOverrodeAWheel) {
  scene::Machine cart = testing::cart();
  const int rear = cart.joint_index(cart.wheels[2].joint);
  cart.joints[static_cast<std::size_t>(rear)].velocity = 0.5;
  const auto build = [&] {
    auto engine = engine_of("Bullet");
    engine->add_machine(cart, Pose::Identity());
    return engine;
  };
  for (const double direction : {1.0, -1.0}) {
    const auto whole = build(), resumed = build();
    const auto ground = testing::slope(radians(6));
    // Below 0.02 rad/s, so that the joint's top speed decides whether this counts as a command.
    whole->set_joint(0, rear, {JointMode::kVelocity, 0.015 * direction});
    run(*whole, ground, 0.5, kStep);
    whole->set_drive(0, {0, 0, true});
    run(*whole, ground, 0.1, kStep);
    load_saved(saved(*whole), *resumed);
    for (PhysicsEngine* engine : {whole.get(), resumed.get()}) run(*engine, ground, 0.2, kStep);
    EXPECT_EQ(digest(*resumed), digest(*whole)) << direction;
  }
}

TEST(JointServo, HashesEveryByteItSaves) {
  JointServo servo, target;
  servo.set({JointMode::kVelocity, 0.3});
  servo.open({}, {}, 0, 0, kStep);
  EXPECT_EQ(test::flip_every_byte(servo, target), "");
  // A mode beyond the last one is invalid.
  std::vector<char> bytes = saved(servo);
  bytes[0] = 5;
  EXPECT_THROW(load_saved(bytes, target), InputError);
}

TEST(DriveLine, IsRefusedByAnotherKindOfDrive) {
  const auto ackermann = make_drive_line(testing::cart()),
             differential = make_drive_line(testing::robot());
  const auto same = make_drive_line(testing::robot());
  EXPECT_EQ(test::flip_every_byte(*differential, *same), "");
  EXPECT_THROW(load_saved(saved(*ackermann), *differential), InputError);
}

}  // namespace
}  // namespace navvy::vehicle
