// SPDX-License-Identifier: Apache-2.0
// Contract of a physics engine (vehicle/physics_engine.h) as a reusable suite.
//
// Needs nothing but this header, GoogleTest and the installed library. Include it in one source and
// instantiate it:
//
//   INSTANTIATE_TEST_SUITE_P(Mine, EngineContract, ::testing::Values(EngineCase{"Mine", make}),
//                            engine_case_name);
//
// A test of a capability is skipped on an engine without it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/saved_state.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// An engine under test.
struct EngineCase {
  std::string name;
  PhysicsEngineFactory make;
  /// Forces and gravity move its machines.
  bool dynamic = true;
};

inline void PrintTo(const EngineCase& engine, std::ostream* out) { *out << engine.name; }

inline std::string engine_case_name(const ::testing::TestParamInfo<EngineCase>& info) {
  return info.param.name;
}

/// Firm level ground at z = 0.
class ContractGround final : public GroundQuery {
 public:
  double height(double, double) const override { return 0; }
  double highest(const Vec2&, const Vec2&) const override { return 0; }
  Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
};

class EngineContract : public ::testing::TestWithParam<EngineCase> {
 protected:
  static constexpr double kStep = 1.0 / 600;  // [s]
  static constexpr double kMass = 1000;       // [kg] of the cube

  /// Returns a cube of 1 m edges that collides, with its centre in the origin of its frame.
  static scene::Machine cube(const std::string& name = "cube") {
    scene::Machine machine;
    machine.name = name;
    machine.kinematic = !GetParam().dynamic;
    scene::Link link;
    link.name = "body";
    link.mass = kMass;
    link.inertia = Mat3::Identity() * (kMass / 6);
    link.collisions.push_back({});
    machine.links.push_back(link);
    return machine;
  }

  static std::unique_ptr<PhysicsEngine> make() {
    return GetParam().make(Vec3(0, 0, -kGravity), {});
  }
  static std::unique_ptr<PhysicsEngine> with_cube(double height) {
    std::unique_ptr<PhysicsEngine> engine = make();
    engine->add_machine(cube(), make_pose(0, 0, height));
    return engine;
  }
  void run(PhysicsEngine& engine, int steps) const {
    for (int i = 0; i < steps; ++i) engine.step(kStep, ground);
  }
  static std::uint64_t digest(const PhysicsEngine& engine) { return hash_of(engine).digest(); }

  ContractGround ground;
};

TEST_P(EngineContract, NumbersMachinesInTheOrderTheyWereAdded) {
  const auto engine = make();
  ASSERT_NE(engine, nullptr);
  EXPECT_EQ(engine->machine_count(), 0);
  EXPECT_EQ(engine->add_machine(cube("a"), make_pose(0, 0, 1)), 0);
  EXPECT_EQ(engine->add_machine(cube("b"), make_pose(5, 0, 2)), 1);
  EXPECT_EQ(engine->machine_count(), 2);
  EXPECT_LT((engine->link(1, 0).X_WL.translation() - Vec3(5, 0, 2)).norm(), 1e-12);
}

TEST_P(EngineContract, PlacesTheBaseByTheModelFrame) {
  scene::Machine machine = cube();
  machine.links[0].X_ML = make_pose(1, 0, 0.5);
  const auto engine = make();
  engine->add_machine(machine, make_pose(2, 3, 4, 0, 0, kPi / 2));
  EXPECT_LT((engine->link(0, 0).X_WL.translation() - Vec3(2, 4, 4.5)).norm(), 1e-12);
}

TEST_P(EngineContract, RefusesAMachineWithoutLinks) {
  const auto engine = make();
  EXPECT_THROW(engine->add_machine(scene::Machine{}, Pose::Identity()), InputError);
}

TEST_P(EngineContract, RefusesAStepThatIsNotPositive) {
  const auto engine = with_cube(1);
  EXPECT_THROW(engine->step(0, ground), SimulationError);
  EXPECT_THROW(engine->step(-kStep, ground), SimulationError);
}

TEST_P(EngineContract, StepsWithoutMachines) {
  const auto engine = make();
  EXPECT_NO_THROW(run(*engine, 3));
}

TEST_P(EngineContract, ReportsTheDriveCommandItFollows) {
  const auto engine = with_cube(1);
  DriveInput input;
  input.speed = 0.5;
  input.steer = -0.25;
  input.brake = false;
  engine->set_drive(0, input);
  EXPECT_EQ(engine->drive(0).speed, 0.5);
  EXPECT_EQ(engine->drive(0).steer, -0.25);
  EXPECT_FALSE(engine->drive(0).brake);
}

TEST_P(EngineContract, VelocitiesAreTheRateOfPoses) {
  const auto engine = with_cube(4);
  engine->apply_impulse(0, 0, Vec3(1000, 200, 0), Vec3::Zero(), Vec3(0, 0, 4));
  run(*engine, 100);
  const LinkState before = engine->link(0, 0);
  run(*engine, 1);
  const LinkState after = engine->link(0, 0);
  const Vec3 moved = (after.X_WL.translation() - before.X_WL.translation()) / kStep;
  // First order in the step: gravity changes the velocity by 0.016 m/s within it.
  EXPECT_LT((moved - 0.5 * (before.v_WL + after.v_WL)).norm(), 0.02);
}

TEST_P(EngineContract, ImpulsesChangeVelocitiesByTheInverseMass) {
  const auto engine = with_cube(3);
  const LinkState before = engine->link(0, 0);
  const Mat6 inverse_mass = engine->inverse_mass(0, 0);
  const Vec3 J_W(300, -200, 100);
  engine->apply_impulse(0, 0, J_W, Vec3::Zero(), before.X_WL.translation());
  const LinkState after = engine->link(0, 0);
  // Order (angular, linear).
  const Vec3 expected = inverse_mass.bottomRightCorner<3, 3>() * J_W;
  EXPECT_LT((after.v_WL - before.v_WL - expected).norm(), 1e-12);
  EXPECT_EQ(inverse_mass.isZero(), !GetParam().dynamic);
}

TEST_P(EngineContract, ImpulsesOfAStepAlsoMoveABodyWithoutJoints) {
  const auto engine = with_cube(3);
  run(*engine, 1);
  const LinkState before = engine->link(0, 0);
  const Vec3 J_W(0, 0, 600);
  engine->apply_impulse_of_step(0, 0, J_W, Vec3::Zero(), before.X_WL.translation(), kStep);
  const Vec3 moved = engine->link(0, 0).X_WL.translation() - before.X_WL.translation();
  const double inverse_mass = GetParam().dynamic ? 1 / kMass : 0;
  EXPECT_LT((moved - kStep * inverse_mass * J_W).norm(), 1e-9);
}

TEST_P(EngineContract, ForcesActInTheNextStepOnly) {
  const auto engine = with_cube(3), plain = with_cube(3);
  const double inverse_mass = GetParam().dynamic ? 1 / kMass : 0;
  engine->add_force(0, 0, Vec3(6000, 0, 0), Vec3(0, 0, 3));
  for (int i = 0; i < 2; ++i) {
    engine->step(kStep, ground);
    plain->step(kStep, ground);
    const double gained = engine->link(0, 0).v_WL.x() - plain->link(0, 0).v_WL.x();
    EXPECT_NEAR(gained, 6000 * inverse_mass * kStep, 1e-9) << "step " << i;
  }
}

TEST_P(EngineContract, FallsUnderTheGravityGiven) {
  const double gravity = GetParam().dynamic ? -1.62 : 0;
  const auto engine = GetParam().make(Vec3(0, 0, -1.62), {});
  engine->add_machine(cube(), make_pose(0, 0, 10));
  run(*engine, 600);
  EXPECT_NEAR(engine->link(0, 0).v_WL.z(), gravity, 1e-3 * 1.62);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 10 + 0.5 * gravity, 0.01);
}

TEST_P(EngineContract, RestsOnTheGround) {
  const auto engine = with_cube(0.5);
  run(*engine, 1200);
  const LinkState base = engine->link(0, 0);
  EXPECT_NEAR(base.X_WL.translation().z(), 0.5, 0.01);
  EXPECT_LT(base.v_WL.norm(), 1e-2);
}

TEST_P(EngineContract, RepeatsBitIdentically) {
  const auto one = with_cube(1), other = with_cube(1);
  run(*one, 200);
  run(*other, 200);
  EXPECT_EQ(digest(*one), digest(*other));
}

TEST_P(EngineContract, ContinuesExactlyFromASavedState) {
  const auto whole = with_cube(0.7), resumed = with_cube(0.7);
  whole->apply_impulse(0, 0, Vec3(400, 0, 0), Vec3::Zero(), Vec3(0, 0, 0.7));
  run(*whole, 50);
  load_saved(saved(*whole), *resumed);
  EXPECT_EQ(digest(*resumed), digest(*whole));
  run(*whole, 100);
  run(*resumed, 100);
  EXPECT_EQ(digest(*resumed), digest(*whole));
  EXPECT_EQ(resumed->link(0, 0).X_WL.matrix(), whole->link(0, 0).X_WL.matrix());
}

TEST_P(EngineContract, RefusesTheStateOfAnotherNumberOfMachines) {
  const auto one = with_cube(1), two = with_cube(1);
  two->add_machine(cube("second"), make_pose(5, 0, 1));
  EXPECT_THROW(load_saved(saved(*one), *two), InputError);
  EXPECT_THROW(load_saved(saved(*two), *one), InputError);
}

TEST_P(EngineContract, CapabilitiesThatAreMissingAreNamed) {
  const auto engine = with_cube(1);
  if (engine->placement() == nullptr) {
    EXPECT_THROW(require_placement(*engine, 0), InputError);
  }
  if (engine->hitches() == nullptr) {
    EXPECT_THROW(require_hitches(*engine), InputError);
  }
  // Readers get the present pose, whatever the engine can do.
  EXPECT_LT((base_target(*engine, 0).p_W - Vec3(0, 0, 1)).norm(), 1e-12);
}

TEST_P(EngineContract, PlacementMovesTheBaseWithinTheDuration) {
  const auto engine = with_cube(1);
  PlacementCapability* placement = engine->placement();
  if (placement == nullptr) GTEST_SKIP() << "the engine has no placement";
  BaseInput input;
  input.p_W = Vec3(1, 0, 1);
  input.duration = 0.5;
  placement->set_base(0, input);
  EXPECT_EQ(placement->base(0).p_W, input.p_W);
  run(*engine, 150);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().x(), 0.5, 0.01);
  run(*engine, 160);
  EXPECT_LT((engine->link(0, 0).X_WL.translation() - input.p_W).norm(), 1e-9);
}

TEST_P(EngineContract, ObstaclesPushAndAreNotPushed) {
  const auto engine = with_cube(0.5);
  ObstacleCapability* obstacles = engine->obstacles();
  if (obstacles == nullptr) GTEST_SKIP() << "the engine has no obstacles";
  scene::Machine wall = cube("wall");
  wall.kinematic = true;
  const int number = obstacles->add_obstacle(wall);
  EXPECT_EQ(number, 0);
  LinkState state;
  state.v_WL = Vec3(0.5, 0, 0);
  for (int i = 0; i < 600; ++i) {
    state.X_WL = make_pose(-1.2 + 0.5 * i * kStep, 0, 0.5);
    obstacles->move_obstacle(number, {state});
    engine->step(kStep, ground);
  }
  // The wall covers 0.5 m, 0.2 m of which are free.
  EXPECT_GT(engine->link(0, 0).X_WL.translation().x(), 0.25);
}

TEST_P(EngineContract, HitchesHoldMachinesTogetherUntilOpened) {
  const auto engine = make();
  HitchCapability* hitches = engine->hitches();
  if (hitches == nullptr) GTEST_SKIP() << "the engine has no hitches";
  engine->add_machine(cube("puller"), make_pose(0, 0, 0.5));
  engine->add_machine(cube("towed"), make_pose(-1.5, 0, 0.5));
  scene::Hitch hitch;
  hitch.hook = Vec3(-0.75, 0, 0);
  hitch.eye = Vec3(0.75, 0, 0);
  EXPECT_EQ(hitches->add_hitch(hitch, 0, 1), 0);
  EXPECT_TRUE(hitches->hitch(0).closed);
  for (int i = 0; i < 300; ++i) {
    engine->add_force(0, 0, Vec3(1.5 * 2 * kMass * kGravity, 0, 0),
                      engine->link(0, 0).X_WL.translation());
    engine->step(kStep, ground);
  }
  EXPECT_LT(hitches->hitch(0).apart, 0.01);
  EXPECT_GT(engine->link(1, 0).v_WL.x(), 0.1);
  hitches->set_hitch(0, false);
  EXPECT_FALSE(hitches->hitch(0).closed);
}

TEST_P(EngineContract, AccountsForEveryImpulse) {
  const auto engine = with_cube(3);
  const AccountCapability* accounts = engine->accounts();
  if (accounts == nullptr) GTEST_SKIP() << "the engine has no accounts";
  const Vec3 J_W(100, 200, 300);
  engine->apply_impulse(0, 0, J_W, Vec3::Zero(), Vec3(0, 0, 3));
  EXPECT_LT((accounts->momentum(0) - J_W).norm(), 1e-9);
  EXPECT_LT((accounts->external_impulse(0) - J_W).norm(), 1e-9);
  EXPECT_EQ(accounts->ground_impulse(0).norm(), 0);
}

}  // namespace navvy::vehicle
