// SPDX-License-Identifier: Apache-2.0
// Contact of two materials compared with closed forms: static and kinetic friction, rebound,
// softness.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::flat;
using testing::run;
using testing::slope;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

/// Returns materials with these values for steel on earth and on stone.
scene::Materials table(double at_rest, double sliding, double restitution = 0,
                       double softness = 0) {
  scene::Materials out;
  out.ground = "earth";
  out.pairs.push_back({{"steel", "earth"}, at_rest, sliding, restitution, softness, ""});
  out.pairs.push_back({{"stone", "steel"}, at_rest, sliding, restitution, softness, ""});
  return out;
}

scene::Machine of(const std::string& material, scene::Machine machine) {
  machine.links[0].material.name = material;
  return machine;
}

scene::Machine ball(double radius) {
  scene::Machine m = testing::box();
  m.links[0].collisions[0].geometry.kind = scene::Geometry::Kind::kSphere;
  m.links[0].collisions[0].geometry.radius = radius;
  return m;
}

/// Travel of a steel box that starts downhill with `speed` [m/s], in `time` [s] on a slope.
struct Slid {
  double distance = 0, speed = 0;
};
Slid slid(const scene::Materials& materials, double angle, double speed, double time) {
  auto engine = make_bullet_engine(kDown, materials);
  const Vec3 place(2, 0, 2 * std::tan(angle) + 0.5 / std::cos(angle));
  engine->add_machine(of("steel", testing::box()),
                      make_pose(place.x(), place.y(), place.z(), 0, -angle));
  const Vec3 down(-std::cos(angle), 0, -std::sin(angle));
  engine->apply_impulse(0, 0, 1000 * speed * down, Vec3::Zero(), place);
  run(*engine, slope(angle), time, kStep);
  const LinkState end = engine->link(0, 0);
  return {(end.X_WL.translation() - place).norm(), end.v_WL.norm()};
}

TEST(BulletMaterials, ABlockStartsAtTheAngleOfStaticFriction) {
  // 1 deg on both sides of atan(0.6); a box of 1 m remains upright on either.
  const scene::Materials materials = table(0.6, 0.45);
  EXPECT_LT(slid(materials, std::atan(0.6) - radians(1), 0, 3).distance, 0.02);
  EXPECT_GT(slid(materials, std::atan(0.6) + radians(1), 0, 3).distance, 1);
}

TEST(BulletMaterials, ABlockThatSlidesStopsBelowTheAngleOfKineticFriction) {
  const scene::Materials materials = table(0.6, 0.45);
  const double angle = std::atan(0.45);
  // It loses g sin(1 deg) / cos(angle) each second: 0.19 m/s of its 1.
  const Slid below = slid(materials, angle - radians(1), 1, 8);
  EXPECT_LT(below.speed, 0.01);
  EXPECT_NEAR(below.distance, 0.5 / (kGravity * std::sin(radians(1)) / std::cos(angle)), 0.3);
  EXPECT_GT(slid(materials, angle + radians(1), 1, 8).speed, 2);
  // Between the two angles a body at rest stays, and a sliding one continues.
  const double between = std::atan(0.52);
  EXPECT_LT(slid(materials, between, 0, 3).distance, 0.02);
  EXPECT_GT(slid(materials, between, 1, 3).speed, 1);
}

TEST(BulletMaterials, ABallReboundsToTheSquareOfItsRestitution) {
  for (const double e : {0.3, 0.6, 0.9})
    for (const double height : {0.5, 2.0}) {
      auto engine = make_bullet_engine(kDown, table(0.5, 0.5, e));
      engine->add_machine(of("steel", ball(0.25)), make_pose(0.03, 0.02, 0.25 + height));
      double highest = 0;
      bool struck = false;
      const double fall = std::sqrt(2 * height / kGravity);
      // Until the top of the first rebound.
      run(*engine, flat(), fall + e * fall + 0.02, kStep, [&](double) {
        const LinkState now = engine->link(0, 0);
        struck = struck || now.v_WL.z() > 0;
        if (struck) highest = std::max(highest, now.X_WL.translation().z() - 0.25);
      });
      EXPECT_TRUE(struck);
      EXPECT_NEAR(highest, e * e * height, 0.05 * e * e * height) << e << ", " << height << " m";
    }
}

TEST(BulletMaterials, ABlockReboundsFlatAndComesToRest) {
  auto engine = make_bullet_engine(kDown, table(0.5, 0.5, 0.5));
  engine->add_machine(of("steel", testing::box()), make_pose(0.03, 0.02, 1.5));
  double highest = 0;
  bool struck = false;
  run(*engine, flat(), 0.7, kStep, [&](double) {
    struck = struck || engine->link(0, 0).v_WL.z() > 0;
    if (struck) highest = std::max(highest, engine->link(0, 0).X_WL.translation().z() - 0.5);
  });
  EXPECT_NEAR(highest, 0.25, 0.05 * 0.25);
  run(*engine, flat(), 4, kStep);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 0.5, 0.01);
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 0.05);
}

TEST(BulletMaterials, SoftnessDeterminesTheSinkage) {
  // 1000 kg by 2e-6 m/N are 19.6 mm, on the ground (four points, or one for a ball) and on a static
  // body.
  const double expected = 2e-6 * 1000 * kGravity;
  const scene::Materials materials = table(0.5, 0.5, 0, 2e-6);
  for (const bool round : {false, true}) {
    auto engine = make_bullet_engine(kDown, materials);
    engine->add_machine(of("steel", round ? ball(0.5) : testing::box()),
                        make_pose(0.03, 0.02, 0.5));
    run(*engine, flat(), 2, kStep);
    EXPECT_NEAR(0.5 - engine->link(0, 0).X_WL.translation().z(), expected, 0.1 * expected) << round;
  }
  auto engine = make_bullet_engine(kDown, materials);
  scene::Machine stands = of("stone", testing::box());
  stands.fixed_base = true;
  engine->add_machine(stands, make_pose(0, 0, 0.5));
  engine->add_machine(of("steel", testing::box()), make_pose(0.1, 0.05, 1.5));
  run(*engine, flat(), 2, kStep);
  EXPECT_NEAR(1.5 - engine->link(1, 0).X_WL.translation().z(), expected, 0.1 * expected);
}

TEST(BulletMaterials, ATableDoesNotAffectLinksWithoutAMaterial) {
  const auto end = [](const scene::Materials& materials, const std::string& material) {
    auto engine = make_bullet_engine(kDown, materials);
    engine->add_machine(of(material, testing::box()), make_pose(0.3, 0.4, 0.9, 0.1));
    engine->apply_impulse(0, 0, Vec3(2000, 500, 0), Vec3::Zero(), Vec3(0.3, 0.4, 0.9));
    run(*engine, flat(), 1, kStep);
    return testing::digest(*engine);
  };
  EXPECT_EQ(end({}, ""), end(table(0.9, 0.1, 0.5, 1e-6), ""));
  EXPECT_NE(end({}, ""), end(table(0.9, 0.1, 0.5, 1e-6), "steel"));
}

TEST(BulletMaterials, MomentumIsConservedInAnImpact) {
  auto engine = make_bullet_engine(Vec3::Zero(), table(0.5, 0.4, 0.7));
  engine->add_machine(of("steel", testing::box()), make_pose(0, 0, 50));
  engine->add_machine(of("stone", testing::box()), make_pose(1.5, 0.1, 50.05));
  engine->apply_impulse(0, 0, Vec3(2000, 0, 0), Vec3::Zero(), Vec3(0, 0, 50));
  run(*engine, flat(), 1, kStep);
  EXPECT_GT(engine->accounts()->momentum(1).x(), 1000);
  EXPECT_LT(
      (engine->accounts()->momentum(0) + engine->accounts()->momentum(1) - Vec3(2000, 0, 0)).norm(),
      1e-3 * 2000);
}

}  // namespace
}  // namespace navvy::vehicle
