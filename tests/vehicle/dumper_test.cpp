// SPDX-License-Identifier: Apache-2.0
// The shipped dumper compared with its data sheet (vehicles/dumper/SOURCE.md), measured in
// simulation.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::dumper;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

/// Returns the time in which the ram lifts the bed to its stop with a load [kg] that hangs 1.7 m
/// ahead of the hinge.
double lift_time(double load) {
  const scene::Machine m = dumper();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  const int joint = m.joint_index("tip_joint"), bed = m.link_index("bed");
  const double top = m.joints[static_cast<std::size_t>(joint)].upper;
  double arrived = -1;
  const auto carry = [&](double) {
    engine->add_force(0, bed, load * kDown, engine->link(0, bed).X_WL * Vec3(1.7, 0, 0.5));
  };
  run(*engine, ground, 1, kStep, carry);
  engine->set_joint(0, joint, {JointMode::kPosition, top});
  run(*engine, ground, 25, kStep, [&](double time) {
    carry(time);
    if (arrived < 0 && engine->joint(0, joint).position > top - radians(2)) arrived = time;
  });
  return arrived;
}

TEST(Dumper, LiftsItsBedInTwelveSecondsEmptyAndWithSixTonnes) {
  // The oil flow alone sets the pace while the pressure suffices: 0.89 m of stroke at 0.075 m/s,
  // slower near the stop.
  EXPECT_NEAR(lift_time(0), 12, 1.2);
  EXPECT_NEAR(lift_time(6000), 12, 1.2);
}

TEST(Dumper, StallsUnderFourteenTonnes) {
  // 220 kN m against 14 t at 1.7 m ahead of the hinge and the bed itself: 246 kN m.
  EXPECT_LT(lift_time(14000), 0);
}

TEST(Dumper, StandsOnItsWheelsWithTheWeightOfItsDataSheet) {
  const scene::Machine m = dumper();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  run(*engine, ground, 4, kStep);
  double load = 0;
  for (int w = 0; w < 4; ++w) load += engine->wheel(0, w).force_W.z();
  EXPECT_NEAR(load, 5940 * kGravity, 1e-3 * 5940 * kGravity);
}

TEST(Dumper, DrivesStraightAndStopsBySpeedAndBrake) {
  const scene::Machine m = dumper();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  engine->set_drive(0, {3, 0, false});
  run(*engine, ground, 5, kStep);
  EXPECT_NEAR(engine->link(0, 0).v_WL.x(), 3, 0.06);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().y(), 0, 1e-3);
  const double x = engine->link(0, 0).X_WL.translation().x();
  engine->set_drive(0, {0, 0, true});
  run(*engine, ground, 4, kStep);
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 1e-3);
  // At least v^2 / (2 mu g), and at most three times that with the brake's 70 kN.
  EXPECT_LT(engine->link(0, 0).X_WL.translation().x() - x, 3 * 9 / (2 * 0.8 * kGravity));
}

}  // namespace
}  // namespace navvy::vehicle
