// SPDX-License-Identifier: Apache-2.0
// Differentials: speeds and torques of their shafts, by the textbook's identities.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "vehicle/drive/drive_line.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using Kind = scene::Differential::Kind;
constexpr double kStep = 1.0 / 600;

/// The cart, its left wheels on ice.
scene::Machine on_ice(const scene::Differential& axles, const scene::Differential& centre = {},
                      bool all_driven = false) {
  scene::Machine cart = testing::cart();
  auto& drive = std::get<scene::AckermannDrive>(cart.drive);
  drive.axles = axles;
  drive.centre = centre;
  for (std::size_t w = 0; w < cart.wheels.size(); ++w) {
    cart.wheels[w].friction = w % 2 == 0 ? 0.05 : 0.8;
    cart.wheels[w].rolling_resistance = 0;  // a separate torque
    cart.wheels[w].driven = all_driven || w >= 2;
  }
  return cart;
}

/// Means over the last second of four up a slope at full power.
struct Climb {
  double speed = 0;  // [m/s]
  // Forces of the rear wheels along the slope [N].
  double left = 0, right = 0;
  // Speeds of the rear wheels [rad/s].
  double spin_left = 0, spin_right = 0;
  // Angular accelerations of the rear wheels [rad/s2].
  double gain_left = 0, gain_right = 0;
  // Mean speed of both front wheels [rad/s].
  double spin_front = 0;
};
Climb climb(const scene::Machine& cart, double angle) {
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(cart, make_pose(0, 0, 0.02, 0, -angle));
  engine->set_drive(0, {1.5, 0, false});
  const Vec3 along(std::cos(angle), 0, std::sin(angle));
  Climb out;
  testing::run(*engine, testing::slope(angle), 3, kStep);
  const double left = engine->wheel(0, 2).spin, right = engine->wheel(0, 3).spin;
  testing::run(*engine, testing::slope(angle), 1, kStep, [&](double) {
    out.speed += kStep * engine->link(0, 0).v_WL.dot(along);
    out.left += kStep * engine->wheel(0, 2).force_W.dot(along);
    out.right += kStep * engine->wheel(0, 3).force_W.dot(along);
    out.spin_left += kStep * engine->wheel(0, 2).spin;
    out.spin_right += kStep * engine->wheel(0, 3).spin;
    out.spin_front += 0.5 * kStep * (engine->wheel(0, 0).spin + engine->wheel(0, 1).spin);
  });
  out.gain_left = engine->wheel(0, 2).spin - left;
  out.gain_right = engine->wheel(0, 3).spin - right;
  return out;
}

TEST(DifferentialLock, AnOpenOneLimitsBothSidesToTheWeakerOne) {
  // 2000 kg on 4 deg require 1370 N; the rear wheel on ice transmits some 250.
  const Climb open = climb(on_ice({}), radians(4));
  EXPECT_LT(open.speed, 0);
  // Torques are equal; the part that the road does not take accelerates the wheel: 100 kg, 0.8 m x
  // 0.8 m.
  const double inertia = 100 * (0.8 * 0.8 + 0.8 * 0.8) / 12,
               radius = testing::cart().wheels[3].radius;
  const double left = open.left * radius + inertia * open.gain_left;
  EXPECT_NEAR(open.right * radius + inertia * open.gain_right, left, 0.05 * left);
  EXPECT_GT(open.spin_left, open.spin_right + 2);
}

TEST(DifferentialLock, ALockedOneTurnsBothSidesEqually) {
  const Climb locked = climb(on_ice({Kind::kLocked, 0, 0}), radians(4));
  EXPECT_GT(locked.speed, 1);
  EXPECT_NEAR(locked.spin_left, locked.spin_right, 1e-3 * locked.spin_right);
  EXPECT_GT(locked.right, 3 * locked.left);
}

TEST(DifferentialLock, LimitedSlipAddsItsLockingTorqueToTheSlowerSide) {
  // 300 N m over a radius of 0.52 m.
  const scene::Differential slips{Kind::kLimitedSlip, 300, 0};
  const scene::Machine cart = on_ice(slips);
  const Climb open = climb(on_ice({}), radians(4)), limited = climb(cart, radians(4));
  EXPECT_GT(limited.spin_left, limited.spin_right + 1) << "it slips here";
  const double radius = cart.wheels[3].radius;
  EXPECT_NEAR((limited.right - limited.left) - (open.right - open.left), 300 / radius,
              0.1 * 300 / radius);
  // A bias larger than the road can take prevents slip altogether.
  const Climb strong = climb(on_ice({Kind::kLimitedSlip, 5000, 0}), radians(4));
  EXPECT_NEAR(strong.spin_left, strong.spin_right, 1e-3 * strong.spin_right);
}

TEST(DifferentialLock, OfTheCentreCouplesTheAxles) {
  scene::Machine cart = on_ice({Kind::kLocked, 0, 0}, {Kind::kLocked, 0, 0}, true);
  // The whole front axle on ice.
  cart.wheels[1].friction = 0.05;
  const Climb all = climb(cart, radians(4));
  EXPECT_GT(all.speed, 1);
  EXPECT_NEAR(all.spin_front, 0.5 * (all.spin_left + all.spin_right), 1e-3 * all.spin_front);
  scene::Machine open_centre = on_ice({Kind::kLocked, 0, 0}, {}, true);
  open_centre.wheels[1].friction = 0.05;
  EXPECT_GT(climb(open_centre, radians(4)).spin_front, all.spin_front + 1);
}

TEST(DifferentialLock, CouplesTheWheelsOfEachDrivenAxle) {
  scene::Machine cart = on_ice({Kind::kLocked, 0, 0}, {Kind::kLocked, 0, 0}, true);
  const auto coupled = make_drive_line(cart)->coupled();
  ASSERT_EQ(coupled.size(), 3u);
  EXPECT_EQ(coupled[0].weight, (std::vector<double>{1, -1, 0, 0}));
  EXPECT_EQ(coupled[1].weight, (std::vector<double>{0, 0, 1, -1}));
  EXPECT_EQ(coupled[2].weight, (std::vector<double>{0.5, 0.5, -0.5, -0.5}));
  EXPECT_TRUE(make_drive_line(on_ice({}))->coupled().empty());
}

TEST(DifferentialLock, InATurnWheelsOfAnOpenOneDifferByTheTrack) {
  const scene::Machine cart = testing::cart();
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(cart, make_pose(0, 0, 0.02));
  const auto& drive = std::get<scene::AckermannDrive>(cart.drive);
  const double R = 6;
  engine->set_drive(0, {1, std::atan(drive.wheelbase / R), false});
  double left = 0, right = 0;
  testing::run(*engine, testing::flat(), 8, kStep, [&](double time) {
    if (time > 4) left += engine->wheel(0, 2).spin, right += engine->wheel(0, 3).spin;
  });
  EXPECT_NEAR(right / left, (R + 0.5 * drive.track) / (R - 0.5 * drive.track), 0.01 * right / left);
}

}  // namespace
}  // namespace navvy::vehicle
