// SPDX-License-Identifier: Apache-2.0
// Rigid contacts of bodies with the ground's patch and with each other.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::box;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

/// 8 m x 8 m around the origin, cells of 0.2 m.
void give_patch(Engine& engine, const std::function<double(double, double)>& height) {
  std::vector<float> heights;
  for (int j = 0; j < 41; ++j)
    for (int i = 0; i < 41; ++i) heights.push_back(static_cast<float>(height(-4 + 0.2 * i, -4 + 0.2 * j)));
  engine.set_ground_patch(41, 41, 0.2, Vec2(-4, -4), heights);
}

TEST(BulletContact, BoxRestsOnThePatchWithItsWeight) {
  // High up and with an asymmetric relief elsewhere: the patch is neither shifted nor mirrored.
  const auto height = [](double x, double y) { return 1000 + (x > 2 && y < -1 ? 1.0 : 0.0); };
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0.3, 0.4, 1000.8));
  engine->add_machine(box(), make_pose(3, -2.5, 1001.8));
  give_patch(*engine, height);
  run(*engine, flat(), 2, kStep);
  Vec3 impulse = Vec3::Zero();
  run(*engine, flat(), 2, kStep, [&](double) { impulse += engine->ground_impulse(0); });
  // 1 cm: the contact is a stiff spring (1000 kg on 4 x 2e7 N/m is 0.1 mm) plus Bullet's margins.
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 1000.5, 0.01);
  EXPECT_NEAR(engine->link(1, 0).X_WL.translation().z(), 1001.5, 0.01);
  // Contacts are found afresh in every step, so a resting box trembles, by less than a centimetre a second.
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 0.02);
  EXPECT_NEAR(impulse.z(), 1000 * kGravity * 2, 0.005 * 1000 * kGravity * 2);
}

TEST(BulletContact, FrictionHoldsBelowAndSlidesAboveItsAngle) {
  for (const double angle : {20.0, 35.0}) {  // the box has mu 0.5, 26.6 degrees
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(box(), make_pose(2, 0, 2 * std::tan(radians(angle)) + 0.5 / std::cos(radians(angle)) + 0.01, 0,
                                         -radians(angle)));
    give_patch(*engine, [&](double x, double) { return std::tan(radians(angle)) * x; });
    run(*engine, flat(), 1, kStep);
    const double v = engine->link(0, 0).v_WL.norm();
    if (angle < 26) {
      EXPECT_LT(v, 0.02);
      // Normal and friction together carry the weight.
      Vec3 impulse = Vec3::Zero();
      run(*engine, flat(), 1, kStep, [&](double) { impulse += engine->ground_impulse(0); });
      EXPECT_LT((impulse + 1000 * kDown).norm(), 0.01 * 1000 * kGravity);
    } else {
      const double expected = kGravity * (std::sin(radians(angle)) - 0.5 * std::cos(radians(angle)));
      EXPECT_NEAR(v, expected, 0.1 * expected);  // 10 %: the fall of the first centimetre
    }
  }
}

TEST(BulletContact, RaisedGroundDoesNotLaunchABody) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0, 0, 0.5));
  give_patch(*engine, [](double, double) { return 0.0; });
  run(*engine, flat(), 1, kStep);
  give_patch(*engine, [](double, double) { return 0.3; });
  double fastest = 0;
  run(*engine, flat(), 3, kStep, [&](double) { fastest = std::max(fastest, engine->link(0, 0).v_WL.z()); });
  EXPECT_LT(fastest, 1.0);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 0.8, 0.02);
}

TEST(BulletContact, LoweredGroundLetsABodyFall) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0, 0, 0.5));
  give_patch(*engine, [](double, double) { return 0.0; });
  run(*engine, flat(), 1, kStep);
  give_patch(*engine, [](double, double) { return -2.0; });
  run(*engine, flat(), 0.2, kStep);
  // No stale contact holds it back: free fall, first order in the step.
  EXPECT_NEAR(engine->link(0, 0).v_WL.z(), -kGravity * 0.2, 0.02 * kGravity * 0.2);
}

TEST(BulletContact, MachinesPushEachOtherAndMomentumIsKept) {
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(box(), Pose::Identity());
  engine->add_machine(box(), make_pose(1.5, 0.1, 0.05));
  engine->apply_impulse(0, 0, Vec3(2000, 0, 0), Vec3::Zero(), Vec3::Zero());
  const auto ground = flat();
  run(*engine, ground, 1, kStep);
  EXPECT_GT(engine->momentum(1).x(), 500);
  // 1e-6: the iterations of the solver act on both bodies alike.
  EXPECT_LT((engine->momentum(0) + engine->momentum(1) - Vec3(2000, 0, 0)).norm(), 2e-3);
  EXPECT_TRUE(engine->ground_impulse(1).isZero());
}

TEST(BulletContact, ExcavatorsStandAndDriveInOneWorldWithoutTouching) {
  const scene::Machine m = testing::ew180();
  const auto together = [&](bool second) {
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(m, Pose::Identity());
    if (second) engine->add_machine(m, make_pose(0, 8, 0, 0, 0, 1));
    engine->set_drive(0, {1, 0.2, false});
    if (second) engine->set_drive(1, {-1, 0.1, false});
    run(*engine, flat(), 2, kStep);
    return engine->link(0, 0).X_WL.translation();
  };
  // 1e-4: the solver stops on the residual of both, so its last digits differ.
  EXPECT_LT((together(true) - together(false)).norm(), 1e-4);
}

}  // namespace
}  // namespace navvy::vehicle
