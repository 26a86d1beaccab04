// SPDX-License-Identifier: Apache-2.0
// A rover whose body only the differential between its two rockers holds upright.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "paths.h"
#include "scene_io/loader.h"
#include "values.h"
#include "vehicle/machines.h"
#include "vehicle/stability.h"

namespace navvy::vehicle {
namespace {

using testing::flat;
using testing::FunctionGround;
using testing::run;

constexpr double kStep = 1.0 / 600;

scene::Machine rover() {
  return scene_io::load_machine(source_dir() + "/tests/vehicle/rocker_bogie.sdf");
}

std::unique_ptr<PhysicsEngine> engine_with(const scene::Machine& machine) {
  auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(machine, Pose::Identity());
  return engine;
}

std::vector<double> loads_of(const PhysicsEngine& engine, const scene::Machine& machine) {
  std::vector<double> out;
  for (std::size_t w = 0; w < machine.wheels.size(); ++w)
    out.push_back(engine.wheel(0, static_cast<int>(w)).force_W.z());
  return out;
}

double pitch_of(const PhysicsEngine& engine, int link) {
  return fixed_angles(engine.link(0, link).X_WL.linear()).y();
}

TEST(RockerBogie, StandsByItself) {
  const scene::Machine machine = rover();
  const auto engine = engine_with(machine);
  const double start = engine->link(0, 0).X_WL.translation().z();
  double jump = 0;
  run(*engine, flat(), 5, kStep, [&](double) {
    jump = std::max(jump, std::abs(engine->link(0, 0).X_WL.translation().z() - start));
  });
  const LinkState body = engine->link(0, 0);
  const double tilt = std::acos(std::min(1.0, body.X_WL.linear()(2, 2)));
  const std::vector<double> loads = loads_of(*engine, machine);
  double sum = 0;
  for (const double load : loads) sum += load;
  const double mean = machine.total_mass() * kGravity / 6;
  print_value("tilt of a standing rocker-bogie [deg]", degrees(tilt), "at most 1", "stands");
  print_value("largest move of its body in 5 s [m]", jump, "at most 0.01", "stands");
  print_value("least load of its wheels / their mean [-]",
              *std::min_element(loads.begin(), loads.end()) / mean, "0.7 or more", "six wheels");
  EXPECT_LT(degrees(tilt), 1);
  EXPECT_LT(jump, 0.01);
  EXPECT_LT(body.v_WL.norm() + body.w_WL.norm(), 1e-3);
  EXPECT_NEAR(sum, 6 * mean, 1e-3 * 6 * mean);
  for (const double load : loads) EXPECT_GT(load, 0.7 * mean);
}

TEST(RockerBogie, TurnsItsBodyByHalfOfWhatOneRockerTurns) {
  // A plank of 0.12 m under the left front wheel.
  const scene::Machine machine = rover();
  const FunctionGround plank([](double x, double y) { return x > 0.25 && y > 0 ? 0.12 : 0.0; });
  const auto engine = engine_with(machine);
  run(*engine, plank, 6, kStep);
  const double body = pitch_of(*engine, 0);
  const double left = pitch_of(*engine, machine.link_index("rocker_left")),
               right = pitch_of(*engine, machine.link_index("rocker_right"));
  print_value("pitch of the body on a plank [deg]", degrees(body),
              std::to_string(degrees(0.5 * (left + right))) + " within 0.02",
              "mean of both rockers");
  EXPECT_LT(degrees(left - right), -5);
  EXPECT_NEAR(degrees(body), degrees(0.5 * (left + right)), 0.02);
  const std::vector<double> loads = loads_of(*engine, machine);
  const double mean = machine.total_mass() * kGravity / 6;
  // Braked wheels keep the forces between them with which they came to rest.
  for (const double load : loads) EXPECT_GT(load, 0.2 * mean);
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 2e-3);
}

TEST(RockerBogie, FallsOnItsNoseWithoutItsDifferential) {
  scene::Machine machine = rover();
  machine.gears.clear();
  const auto engine = engine_with(machine);
  run(*engine, flat(), 5, kStep);
  // To the stops of its rockers.
  EXPECT_GT(std::abs(degrees(pitch_of(*engine, 0))), 20);
}

TEST(RockerBogie, DrivesOverAPlankWithAllWheelsOnTheGround) {
  const scene::Machine machine = rover();
  // Ramps of 0.4 m up and down, on the left side only.
  const FunctionGround plank([](double x, double y) {
    const double along = std::clamp(std::min(x - 1.0, 2.6 - x) / 0.4, 0.0, 1.0);
    return y > 0 ? 0.12 * along : 0.0;
  });
  const auto engine = engine_with(machine);
  run(*engine, plank, 2, kStep);
  engine->set_drive(0, {0.4, 0, false});
  double lowest = 1e9, worst = 0;
  run(*engine, plank, 10, kStep, [&](double) {
    for (const double load : loads_of(*engine, machine)) lowest = std::min(lowest, load);
    worst = std::max(worst, std::abs(pitch_of(*engine, 0)));
  });
  print_value("least wheel load over a plank [N]", lowest, "more than 0", "all wheels carry");
  print_value("largest pitch of the body over a plank [deg]", degrees(worst), "at most 10",
              "half of the rocker's");
  EXPECT_GT(engine->link(0, 0).X_WL.translation().x(), 3);
  EXPECT_GT(lowest, 0);
  EXPECT_LT(degrees(worst), 10);
}

}  // namespace
}  // namespace navvy::vehicle
