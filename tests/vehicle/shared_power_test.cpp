// SPDX-License-Identifier: Apache-2.0
// Drive and pump on one engine: variants of the shipped excavator that lift and climb at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include "core/saved_state.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::ew180;
using testing::run;
using testing::slope;

constexpr double kStep = 1.0 / 600;
constexpr double kEngine = 100e3;  // [W]

/// 100 kW at 200 rad/s, its largest power.
scene::CombustionEngine diesel() {
  scene::CombustionEngine engine;
  engine.curve = {{80, 450}, {140, 560}, {200, 500}, {220, 400}};
  engine.braking_torque = 80;
  engine.gears = {3, 1.5};
  engine.final_ratio = 20;
  return engine;
}

scene::Machine excavator(double engine_power,
                         const std::optional<scene::CombustionEngine>& engine = {}) {
  scene::Machine machine = ew180(0.2, -1.2, -1.3);
  auto& drive = std::get<scene::AckermannDrive>(machine.drive);
  drive.engine_power = engine_power;
  drive.engine = engine;
  return machine;
}

struct Powers {
  // Largest power of pump and drive together [W].
  double most = 0;
  // Largest power of the pump [W].
  double pump = 0;
  // Largest power of the drive [W].
  double drive = 0;
  // Final speed [m/s].
  double speed = 0;
  // Largest power reported by the engine itself [W].
  double shared = 0;
  std::uint64_t digest = 0;
};

/// Climbs, and lifts its boom from 3 s on.
Powers climb_and_lift(const scene::Machine& machine) {
  const double angle = radians(8);
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(machine, make_pose(0, 0, 0.02, 0, -angle));
  engine->set_drive(0, {2.5, 0, false});
  Powers out;
  run(*engine, slope(angle), 5, kStep, [&](double t) {
    if (t > 3 && t < 3 + 1.5 * kStep)
      engine->set_joint(0, machine.joint_index(machine.arm.boom), {JointMode::kVelocity, 3});
    double drive = 0;
    for (int w = 0; w < static_cast<int>(machine.wheels.size()); ++w)
      drive += engine->wheel(0, w).shaft_torque * engine->wheel(0, w).spin;
    const double pump = engine->power()->pump(0).flow * engine->power()->pump(0).pressure;
    out.pump = std::max(out.pump, pump);
    out.drive = std::max(out.drive, drive);
    out.most = std::max(out.most, pump + drive);
    out.shared = std::max(out.shared, engine->power()->drive_engine(0).power);
  });
  out.speed = engine->link(0, 0).X_WL.linear().col(0).dot(engine->link(0, 0).v_WL);
  out.digest = testing::digest(*engine);
  return out;
}

TEST(SharedPower, OfAHydrostaticDriveAndThePumpStaysWithinTheEngine) {
  const Powers own = climb_and_lift(excavator(0)), shared = climb_and_lift(excavator(kEngine));
  print_value("pump and drive at once, each with its own power [kW]", own.most / 1e3, "180 at most",
              "90 + 90, vehicles/ew180/SOURCE.md");
  print_value("pump and drive at once on one engine of 100 kW [kW]", shared.most / 1e3,
              "100, tolerance 2.5 %", "docs/machines.md, drive");
  EXPECT_GT(own.most, 1.3 * kEngine);
  EXPECT_EQ(own.shared, 0);
  // 2.5 %: the drive receives the pump's power one step later, and while valves open that rises by
  // 1.4 kW per step.
  EXPECT_LE(shared.most, 1.025 * kEngine);
  EXPECT_GT(shared.most, 0.9 * kEngine) << "it is used";
  EXPECT_NEAR(shared.shared, shared.most, 0.025 * kEngine);
  EXPECT_LT(shared.speed, own.speed - 0.2) << "the pump has priority";
  EXPECT_NEAR(shared.pump, own.pump, 0.1 * own.pump);
}

TEST(SharedPower, OfAnEngineWithGearsStaysWithinItsMaximum) {
  const scene::CombustionEngine engine = diesel();
  const scene::CombustionEngine::Point rated = scene::rated_point(engine);
  EXPECT_NEAR(rated.speed * rated.torque, kEngine, 1);
  const Powers shared = climb_and_lift(excavator(kEngine, engine)),
               own = climb_and_lift(excavator(0, engine));
  print_value("pump and drive at once on a torque curve of 100 kW [kW]", shared.shared / 1e3,
              "100, tolerance 2.5 %", "docs/machines.md, engine and gears");
  // As above.
  EXPECT_LE(shared.shared, 1.025 * kEngine);
  EXPECT_LE(shared.most, 1.025 * kEngine);
  EXPECT_GT(shared.shared, 0.9 * kEngine);
  EXPECT_GT(own.most, 1.1 * shared.most);
}

TEST(SharedPower, HasNoEffectWithALargeEngine) {
  const Powers own = climb_and_lift(excavator(0)), plenty = climb_and_lift(excavator(1e7));
  EXPECT_EQ(plenty.digest, own.digest);
  EXPECT_EQ(plenty.speed, own.speed);
}

TEST(SharedPower, DoesNotLimitBraking) {
  // Down 8 deg the drive holds 25 kN at 2 m/s; the engine's power is available to the pump only.
  const double angle = radians(-8);
  scene::Machine machine = excavator(100);
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(machine, make_pose(0, 0, 0.02, 0, -angle));
  engine->set_drive(0, {2, 0, false});
  run(*engine, slope(angle), 6, kStep);
  EXPECT_NEAR(engine->link(0, 0).X_WL.linear().col(0).dot(engine->link(0, 0).v_WL), 2, 0.1);
}

}  // namespace
}  // namespace navvy::vehicle
