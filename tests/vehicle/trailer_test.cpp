// SPDX-License-Identifier: Apache-2.0
// The shipped robot with its trailer: a machine of two files and a hitch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "paths.h"
#include "scene_io/loader.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
// Distances behind the robot's axle and ahead of the trailer's [m].
constexpr double kHitch = 0.4, kDrawbar = 0.6;

scene::Machine train() {
  return scene_io::load_machine(navvy::source_dir() + "/vehicles/robot_with_trailer/model.sdf");
}

/// Returns the middle of the trailer's axle on the ground.
Vec3 trailer(const PhysicsEngine& engine, const scene::Machine& machine) {
  return engine.link(0, machine.link_index("robot_trailer::chassis")).X_WL.translation();
}

TEST(Trailer, StandsOnItsWheelsAndItsHitch) {
  const scene::Machine machine = train();
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(machine, Pose::Identity());
  run(*engine, flat(), 2, kStep);
  double carried = 0;
  for (int w = 0; w < static_cast<int>(machine.wheels.size()); ++w)
    carried += engine->wheel(0, w).force_W.z();
  EXPECT_NEAR(carried, 68.5 * kGravity, 1);
  EXPECT_LT((trailer(*engine, machine) - Vec3(-kHitch - kDrawbar, 0, 0)).norm(), 0.005);
}

TEST(Trailer, FollowsTheCircleOfItsGeometry) {
  // In a steady circle the trailer's axle points at the robot's centre of rotation: R^2 + h^2 = r^2
  // + l^2.
  const scene::Machine machine = train();
  for (const double yaw_rate : {0.4, -0.25}) {
    const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
    engine->add_machine(machine, Pose::Identity());
    engine->set_drive(0, {0.5, yaw_rate, false});
    const double circle = 2 * kPi / std::abs(yaw_rate);
    run(*engine, flat(), circle, kStep);
    double robots = 0, trailers = 0;
    int samples = 0;
    run(*engine, flat(), circle, kStep, [&](double) {
      const LinkState base = engine->link(0, 0);
      // From its own motion: centre of the circle on its left, at v / yaw rate.
      const Vec3 centre =
          base.X_WL * Vec3(0, base.X_WL.linear().col(0).dot(base.v_WL) / base.w_WL.z(), 0);
      robots += (base.X_WL.translation() - centre).head<2>().norm();
      trailers += (trailer(*engine, machine) - centre).head<2>().norm();
      ++samples;
    });
    const double R = robots / samples;
    const double expected = std::sqrt(R * R + kHitch * kHitch - kDrawbar * kDrawbar);
    print_value("radius of the trailer's axle [m]", trailers / samples,
                std::to_string(expected) + " +-3 %", "sqrt(R^2 + h^2 - l^2)");
    EXPECT_NEAR(trailers / samples, expected, 0.03 * expected);
  }
}

TEST(Trailer, JackknifesWhenReversing) {
  // In reverse it jackknifes until the hitch stops it: 75 deg.
  const scene::Machine machine = train();
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(machine, Pose::Identity());
  engine->set_drive(0, {-0.3, 0.15, false});
  double most = 0;
  run(*engine, flat(), 12, kStep, [&](double) {
    const Mat3 robot = engine->link(0, 0).X_WL.linear();
    const Mat3 drawn = engine->link(0, machine.link_index("robot_trailer::chassis")).X_WL.linear();
    most = std::max(most, std::acos(std::clamp(robot.col(0).dot(drawn.col(0)), -1.0, 1.0)));
  });
  EXPECT_GT(degrees(most), 70);
  EXPECT_LT(degrees(most), 75.5);
}

}  // namespace
}  // namespace navvy::vehicle
