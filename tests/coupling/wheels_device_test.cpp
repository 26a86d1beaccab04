// SPDX-License-Identifier: Apache-2.0
// The excavator on columns: into a trench of its size, onto spoil, and two machines on one ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/step_kinds.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "sim/world.h"

namespace navvy::coupling {
namespace {

constexpr double kWheelRadius = 0.525;

/// Returns the shipped site with these shapes instead of its own; excavators side by side with
/// their rear axles at x = -9, 6 m apart to the left, without programs.
scene::Scene yard(const std::vector<scene::GroundFeature>& features, int machines = 1) {
  scene::Scene world =
      scene_io::load_scene(navvy::source_dir() + "/scenarios/trench.sdf", control::step_kinds());
  world.ground.features = features;
  world.machines.at(0).program = {};
  for (int m = 1; m < machines; ++m) {
    world.machines.push_back(world.machines[0]);
    world.machines.back().name += std::to_string(m);
    world.machines.back().X_WM.translation().y() += 6.0 * m;
  }
  return world;
}

device::Device& shared_device() {
  static device::Device device;
  return device;
}

template <class Each>
void run(sim::World& world, double seconds, const Each& each) {
  const double end = world.time() + seconds;
  while (world.time() < end) {
    world.step();
    each();
  }
}

double wheel_height(const sim::World& world, int machine, int wheel) {
  return world.machines().at(machine).wheel(wheel).state().X_WWheel.translation().z();
}

TEST(Wheels, DropIntoATrenchOfTheMachineWithoutLaunchingIt) {
  scene::GroundFeature trench;
  trench.kind = scene::GroundFeature::Kind::kTrench;
  trench.center = Vec2(-4.5, 0);
  trench.length = 1.05;  // along the path: one bucket
  trench.width = 8;
  trench.height = 0.8;
  sim::World world(yard({trench}), shared_device());
  world.commands().set(world.machines().at(0), {0.8, 0, false});
  double lowest = 1, fastest = 0;
  run(world, 5, [&] {
    lowest = std::min({lowest, wheel_height(world, 0, 0), wheel_height(world, 0, 1)});
    fastest = std::max(fastest, world.machines().at(0).link(0).velocity().z());
  });
  EXPECT_LT(lowest, kWheelRadius - 0.25);  // the front wheels are in it
  EXPECT_LT(fastest, 1.0);                 // upwards; as in bullet_drive_test
  EXPECT_EQ(world.soil().mass_ledger().error, 0);
}

TEST(Wheels, RiseOnASpoilHeapOnOneSideOnly) {
  scene::GroundFeature heap;
  heap.kind = scene::GroundFeature::Kind::kStockpile;
  heap.center = Vec2(-3.5, 0.97);
  heap.height = 0.3;
  heap.angle = radians(20);
  sim::World world(yard({heap}), shared_device());
  world.commands().set(world.machines().at(0), {0.8, 0, false});
  double left = 0, right = 0, fastest = 0;
  run(world, 6, [&] {
    left = std::max(left, wheel_height(world, 0, 0));
    right = std::max(right, wheel_height(world, 0, 1));
    for (int w = 0; w < 4; ++w)
      fastest = std::max(fastest, std::abs(world.machines().at(0).wheel(w).state().v_W.z()));
  });
  EXPECT_GT(left, kWheelRadius + 0.15);  // of 0.3 m: the tyre presses a rut into the top
  EXPECT_LT(right, kWheelRadius + 0.05);
  EXPECT_LT(fastest, 1.0);
}

TEST(Wheels, StandOnASlopeFromTheStartAndClimbIt) {
  scene::GroundFeature slope;
  slope.kind = scene::GroundFeature::Kind::kSlope;
  slope.angle = radians(8);
  sim::World world(yard({slope}), shared_device());
  double most = 0;
  run(world, 1, [&] {
    for (int w = 0; w < 4; ++w)
      most = std::max(most, world.machines().at(0).wheel(w).state().force_W.norm());
  });
  // The heaviest wheel of the machine at rest carries 0.35 of its weight; it settles on tyres that
  // deflect by 30 mm.
  EXPECT_LT(most, 0.6 * 18000 * kGravity);
  world.commands().set(world.machines().at(0), {0.8, 0, false});
  run(world, 5, [] {});
  EXPECT_GT(world.machines().at(0).link(0).pose().translation().x(), -9 + 2);
}

TEST(Wheels, StandAtThePoseOfTheSceneAboveTheirGround) {
  scene::GroundFeature slope;
  slope.kind = scene::GroundFeature::Kind::kSlope;
  slope.angle = radians(6);
  for (const auto& features :
       {std::vector<scene::GroundFeature>{}, std::vector<scene::GroundFeature>{slope}}) {
    scene::Scene lifted = yard(features);
    lifted.machines[0].X_WM.translation().z() += 1.0;
    lifted.machines[0].X_WM.linear() = make_pose(0, 0, 0, 0.1, 0.2, 0).linear();
    const sim::World as_it_is(yard(features), shared_device()),
        as_commanded(lifted, shared_device());
    const Pose a = as_it_is.machines().at(0).link(0).pose(),
               b = as_commanded.machines().at(0).link(0).pose();
    EXPECT_NEAR(b.translation().z() - a.translation().z(), 1.0, 1e-6);
    const Mat3 turn = a.linear().transpose() * b.linear();
    EXPECT_NEAR((turn - make_pose(0, 0, 0, 0.1, 0.2, 0).linear()).norm(), 0, 1e-9);
  }
}

TEST(Wheels, OfTwoExcavatorsDoNotInteract) {
  sim::World alone(yard({}), shared_device()), both(yard({}, 2), shared_device());
  for (sim::World* world : {&alone, &both}) {
    world->commands().set(world->machines().at(0), {1.0, 0, false});
    run(*world, 1.5, [] {});
  }
  const Vec3 difference = both.machines().at(0).link(0).pose().translation() -
                          alone.machines().at(0).link(0).pose().translation();
  EXPECT_GT(alone.machines().at(0).link(0).pose().translation().x(), -9 + 0.2);
  // One sweep of the joint solver serves both machines; its residual grows in the ruts: 2 mm of 0.5
  // m measured.
  EXPECT_LT(difference.norm(),
            0.01 * (alone.machines().at(0).link(0).pose().translation().x() + 9));
  // The other one has not moved; 5 mm: it settles on its tyres.
  EXPECT_LT((both.machines().at(1).link(0).pose().translation() - Vec3(-9, 6, 0)).head<2>().norm(),
            5e-3);
}

}  // namespace
}  // namespace navvy::coupling
