// SPDX-License-Identifier: Apache-2.0
// Loads, drives, steers and brakes every shipped vehicle; a new vehicle file is found by this test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "paths.h"
#include "scene_io/loader.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;

std::vector<std::string> shipped_vehicles() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(navvy::source_dir() + "/vehicles"))
    if (std::filesystem::exists(entry.path() / "model.sdf"))
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedVehicles : public ::testing::TestWithParam<std::string> {
 protected:
  ShippedVehicles()
      : machine(scene_io::load_machine(navvy::source_dir() + "/vehicles/" + GetParam() +
                                       "/model.sdf")) {
    engine->add_machine(machine, Pose::Identity());
  }
  double forward() const {
    const LinkState base = engine->link(0, 0);
    return base.X_WL.linear().col(0).dot(base.v_WL);
  }
  double heading() const {
    const Vec3 ahead = engine->link(0, 0).X_WL.linear().col(0);
    return std::atan2(ahead.y(), ahead.x());
  }
  /// To the left: half of its steering range, or half a radian per second.
  double steering() const {
    if (const auto* steered = std::get_if<scene::AckermannDrive>(&machine.drive))
      return 0.5 * steered->max_steer;
    if (const auto* linkage = std::get_if<scene::LinkageDrive>(&machine.drive))
      return 0.5 * linkage->max_steer * linkage->gear_ratio;
    return 0.5;
  }
  bool drives() const {
    return std::any_of(machine.wheels.begin(), machine.wheels.end(),
                       [](const scene::Wheel& w) { return w.driven; });
  }

  scene::Machine machine;
  std::unique_ptr<PhysicsEngine> engine = make_bullet_engine(Vec3(0, 0, -kGravity));
};

TEST_P(ShippedVehicles, DriveSteerAndBrake) {
  run(*engine, flat(), 2, kStep);
  if (!drives()) {
    // A towed machine, or a tool on a rig: it stays where it was placed.
    EXPECT_LT(engine->link(0, 0).v_WL.norm(), 1e-2);
    return;
  }
  const double speed = 0.4 * scene::powertrain(machine.drive).max_speed;
  engine->set_drive(0, {speed, 0, false});
  run(*engine, flat(), 5, kStep);
  print_value("speed / commanded speed", forward() / speed, "0.9 .. 1.05", "a governed drive");
  EXPECT_GT(forward(), 0.9 * speed);
  EXPECT_LT(forward(), 1.05 * speed);
  const double straight = heading();
  EXPECT_NEAR(straight, 0, radians(2));

  engine->set_drive(0, {speed, steering(), false});
  double turned = 0, last = straight;
  run(*engine, flat(), 3, kStep, [&](double) {
    turned += std::remainder(heading() - last, 2 * kPi);
    last = heading();
  });
  print_value("turned to the left in 3 s [rad]", turned, "above 0.1", "steering");
  EXPECT_GT(turned, 0.1);
  EXPECT_GT(forward(), 0.5 * speed);

  engine->set_drive(0, {0, 0, true});
  run(*engine, flat(), 3, kStep);
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 0.01 * speed);
  const Vec3 stopped = engine->link(0, 0).X_WL.translation();
  run(*engine, flat(), 2, kStep);
  EXPECT_LT((engine->link(0, 0).X_WL.translation() - stopped).norm(), 1e-3);
  // It is still upright.
  EXPECT_GT(engine->link(0, 0).X_WL.linear().col(2).z(), std::cos(radians(3)));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedVehicles, ::testing::ValuesIn(shipped_vehicles()),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace navvy::vehicle
