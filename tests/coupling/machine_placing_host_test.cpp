// SPDX-License-Identifier: Apache-2.0
// Initial pose of a model's base link: given by its file, relative to the ground or to the world.
#include "coupling/machine_placing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "vehicle/physics_engine.h"

namespace navvy::coupling {
namespace {

constexpr double kMillimetre = 1e-3;

heightfield::Ground ground_of(const std::function<double(double, double)>& height) {
  heightfield::GroundSetup setup;
  setup.nx = setup.ny = 80;
  setup.cell = 0.1;
  setup.origin = Vec2(-4, -4);
  setup.datum = -5;
  setup.soils = {scene::Soil{}};
  setup.soils[0].name = "loam";
  setup.layers = {{"loam", 20}};
  setup.surface = [height](int ix, int iy) {
    return height(-4 + 0.1 * (ix + 0.5), -4 + 0.1 * (iy + 0.5));
  };
  return heightfield::Ground(std::move(setup));
}

scene::Link link(const std::string& name, const Pose& X_ML) {
  scene::Link out;
  out.name = name;
  out.X_ML = X_ML;
  return out;
}

/// A block whose base link is 0.16 m above the model frame and rotated in it.
scene::MachineInWorld block() {
  scene::MachineInWorld placed;
  placed.name = placed.machine.name = "block";
  placed.machine.links = {link("body", make_pose(0.05, 0.02, 0.16, 0, 0, 0.3))};
  return placed;
}

/// The block on three hinge wheels of 0.1 m whose lowest points are `drop` below the model frame.
scene::MachineInWorld robot(double drop = 0) {
  scene::MachineInWorld placed = block();
  for (const Vec2& at : {Vec2(0.1, 0.2), Vec2(0.1, -0.2), Vec2(-0.25, 0)}) {
    const std::string name = "wheel" + std::to_string(placed.machine.joints.size());
    scene::Joint spin;
    spin.name = name;
    spin.type = scene::Joint::Type::kRevolute;
    spin.parent = 0;
    spin.child = static_cast<int>(placed.machine.links.size());
    spin.axis = Vec3::UnitY();
    placed.machine.joints.push_back(spin);
    placed.machine.links.push_back(link(name, make_pose(at.x(), at.y(), 0.1 - drop, 0, 0, 0)));
    scene::Wheel wheel;
    wheel.joint = name;
    wheel.radius = 0.1;
    placed.machine.wheels.push_back(wheel);
  }
  return placed;
}

/// Initial pose of the base link; both engines must agree.
Pose started(const scene::MachineInWorld& placed, const heightfield::Ground& ground) {
  const auto dynamic = vehicle::make_bullet_engine(Vec3(0, 0, -kGravity));
  const auto kinematic = vehicle::make_kinematic_engine();
  dynamic->add_machine(placed.machine, place(placed, ground));
  kinematic->add_machine(placed.machine, place(placed, ground));
  const Pose X_WB = dynamic->link(0, 0).X_WL;
  EXPECT_LT((X_WB.matrix() - kinematic->link(0, 0).X_WL.matrix()).norm(), 1e-9);
  EXPECT_LT((X_WB.matrix() - base_pose(placed.machine, place(placed, ground)).matrix()).norm(),
            1e-9);
  return X_WB;
}

TEST(Placing, OffTheGroundTheBaseHasThePoseOfTheFile) {
  const heightfield::Ground ground = ground_of([](double x, double) { return 1 + 0.2 * x; });
  for (scene::MachineInWorld placed : {block(), robot(), robot(0.3)}) {
    placed.on_ground = false;
    placed.X_WM = make_pose(0.7, -0.4, 2.5, 0.1, -0.2, 0.9);
    const Pose expected = placed.X_WM * placed.machine.links[0].X_ML;
    const Pose X_WB = started(placed, ground);
    EXPECT_LT((X_WB.translation() - expected.translation()).norm(), kMillimetre);
    EXPECT_LT((X_WB.linear() - expected.linear()).norm(), 1e-6);
  }
}

TEST(Placing, OnLevelGroundTheBaseHasTheHeightOfTheFile) {
  const heightfield::Ground ground = ground_of([](double, double) { return 1.25; });
  for (scene::MachineInWorld placed : {block(), robot()}) {
    placed.X_WM = make_pose(0.7, -0.4, 0, 0, 0, 0.9);
    EXPECT_NEAR(started(placed, ground).translation().z(), 1.25 + 0.16, kMillimetre);
    placed.X_WM.translation().z() = 0.5;
    EXPECT_NEAR(started(placed, ground).translation().z(), 1.25 + 0.16 + 0.5, kMillimetre);
  }
  // The frame is above the lowest points of the wheels: the machine stands on its wheels and not on
  // its frame.
  EXPECT_NEAR(started(robot(0.3), ground).translation().z(), 1.25 + 0.3 + 0.16, kMillimetre);
}

TEST(Placing, OnASlopeTheBaseHasTheHeightOfTheFileAboveThePlaneUnderItsWheels) {
  const Vec3 up = Vec3(-0.2, 0.1, 1).normalized();  // of z = 1 + 0.2 x - 0.1 y
  const heightfield::Ground ground =
      ground_of([](double x, double y) { return 1 + 0.2 * x - 0.1 * y; });
  for (const double yaw : {0.0, 0.9, -2.2}) {
    scene::MachineInWorld placed = robot();
    placed.X_WM = make_pose(0.7, -0.4, 0, 0, 0, yaw);
    const Pose X_WB = started(placed, ground);
    EXPECT_NEAR((X_WB.translation() - Vec3(0, 0, 1)).dot(up), 0.16, kMillimetre) << "yaw " << yaw;
    EXPECT_LT((X_WB.linear().col(2) - up).norm(), 1e-6) << "yaw " << yaw;
  }
}

TEST(Placing, OnRoughGroundNoWheelStartsInIt) {
  const auto bumps = [](double x, double y) { return 0.1 * std::sin(5 * x) * std::cos(4 * y); };
  const heightfield::Ground ground = ground_of(bumps);
  scene::MachineInWorld placed = robot();
  const Pose X_WM = place(placed, ground);
  double least = 1;
  for (const scene::Link& wheel : placed.machine.links) {
    if (wheel.name == "body") continue;
    const Vec3 foot = X_WM * wheel.X_ML.translation() - 0.1 * X_WM.linear().col(2);
    least = std::min(least, foot.z() - ground.sample(foot.x(), foot.y()));
  }
  // The lowest wheel touches.
  EXPECT_NEAR(least, 0, 1e-6);
}

}  // namespace
}  // namespace navvy::coupling
