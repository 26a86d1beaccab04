// SPDX-License-Identifier: Apache-2.0
#include "vehicle/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::arm;
using testing::box_link;

scene::Cylinder direct() {
  scene::Cylinder c;
  c.name = "boom_cylinder";
  c.joint = "boom_joint";
  c.base_link = "base";
  c.rod_link = "boom";
  c.p_base = Vec3(0.45, 0, 1.4);
  c.p_rod = Vec3(2.2, 0, 0.55);
  return c;
}

scene::Cylinder linked() {
  scene::Cylinder c;
  c.name = "bucket_cylinder";
  c.joint = "bucket_joint";
  c.base_link = "stick";
  c.rod_link = "bucket";
  c.p_base = Vec3(-0.1, 0, 0.31);
  c.has_linkage = true;
  c.p_rocker = Vec3(2.08, 0, 0);
  c.rocker_rod = 0.72;  // beyond the coupler's pin
  c.rocker_coupler = 0.697;
  c.coupler = 0.62;
  c.p_coupler = Vec3(-0.29, 0, 0.33);
  return c;
}

scene::Machine arm_with_bucket() {
  scene::Machine m = arm();
  m.links.push_back(
      box_link("bucket", make_pose(7.45, 0, 2), 700, Vec3(0.7, 0, 0.2), Vec3(1.4, 1, 0.6)));
  scene::Joint joint = testing::revolute("bucket_joint", 2, 3, -Vec3::UnitY());
  joint.has_limits = true;
  joint.lower = -2.6;
  joint.upper = 0.4;
  m.joints.push_back(joint);
  return m;
}

TEST(ForwardKinematics, PositiveAngleOfAPitchJointLiftsTheLink) {
  const scene::Machine m = arm();
  const auto poses = forward_kinematics(m, make_pose(10, 20, 30), {radians(90), radians(-90)});
  ASSERT_EQ(poses.size(), 3u);
  // Boom straight up from (0, 0, 2), stick forward from its end.
  EXPECT_TRUE((poses[2] * Vec3::Zero()).isApprox(Vec3(10, 20, 37), 1e-12));
  EXPECT_TRUE((poses[2] * Vec3(3, 0, 0)).isApprox(Vec3(13, 20, 37), 1e-12));
}

TEST(ForwardKinematics, TurnsAboutAJointFrameThatIsNotTheLinksOrigin) {
  scene::Machine m = arm();
  m.joints[0].X_LcJ = make_pose(1, 0, 0);  // pivot at x = 1 of the boom
  const auto poses = forward_kinematics(m, Pose::Identity(), {radians(90), 0});
  EXPECT_TRUE((poses[1] * Vec3(1, 0, 0)).isApprox(Vec3(1, 0, 2), 1e-12));
  EXPECT_TRUE((poses[1] * Vec3(2, 0, 0)).isApprox(Vec3(1, 0, 3), 1e-12));
}

TEST(CylinderGeometry, LeverIsTheDerivativeOfTheLength) {
  const scene::Machine m = arm_with_bucket();
  for (const scene::Cylinder& c : {direct(), linked()})
    for (double q = -0.8; q <= 0.35; q += 0.05) {
      const double h = 1e-6;
      const double slope =
          (cylinder_geometry(m, c, q + h).length - cylinder_geometry(m, c, q - h).length) / (2 * h);
      // 1e-8: truncation h^2 and rounding 1e-16 / h of the difference.
      EXPECT_NEAR(cylinder_geometry(m, c, q).lever, slope, 1e-8) << c.name << " at " << q;
    }
}

// The linkage found by brute force: of all rocker angles those at which the coupler has its length.
TEST(CylinderGeometry, FourBarAgreesWithASearchOverTheRockersAngle) {
  const scene::Machine m = arm_with_bucket();
  const scene::Cylinder c = linked();
  for (double q = -2.6; q <= 0.4; q += 0.1) {
    const Vec3 bucket_pin(2.45, 0, 0);
    const Vec3 coupler_pin =
        bucket_pin + Eigen::AngleAxisd(q, -Vec3::UnitY()).toRotationMatrix() * c.p_coupler;
    double best = 1e9, length = 0;
    constexpr int kAngles = 200000;
    for (int i = 0; i < kAngles; ++i) {
      const double a = 2 * kPi * i / kAngles;
      const Vec3 direction(std::cos(a), 0, std::sin(a));
      const Vec3 pin = c.p_rocker + c.rocker_coupler * direction;
      // The outer assembly: beyond the line from rocker pivot to coupler pin, seen from the
      // bucket's pin.
      const Vec3 line = coupler_pin - c.p_rocker;
      const double side = line.cross(pin - c.p_rocker).y();
      const double error = std::abs((pin - coupler_pin).norm() - c.coupler);
      if (side < 0 && error < best) {
        best = error;
        length = (c.p_rocker + c.rocker_rod * direction - c.p_base).norm();
      }
    }
    // 1e-4: the step of the search is 3e-5 rad on a 0.72 m rocker, more where the coupler turns
    // flat.
    EXPECT_NEAR(cylinder_geometry(m, c, q).length, length, 1e-4) << q;
  }
}

TEST(CylinderLimits, ExtensionFillsTheHeadSide) {
  const scene::Machine m = arm_with_bucket();
  scene::Cylinder c = direct();
  c.count = 2;
  const double head = 2 * kPi / 4 * c.bore * c.bore,
               rod = 2 * kPi / 4 * (c.bore * c.bore - c.rod * c.rod);
  const double lever = cylinder_geometry(m, c, 0.2).lever;
  ASSERT_GT(lever, 0);
  const CylinderLimits lift = cylinder_limits(m, c, 0.2);
  EXPECT_DOUBLE_EQ(lift.torque_positive, c.pressure * head * lever);
  EXPECT_DOUBLE_EQ(lift.torque_negative, c.pressure * rod * lever);
  EXPECT_DOUBLE_EQ(lift.speed_positive, c.flow / (head * lever));
  EXPECT_DOUBLE_EQ(lift.speed_negative, c.flow / (rod * lever));

  // The bucket's cylinder extends to curl in, which is the negative direction.
  const scene::Cylinder k = linked();
  ASSERT_LT(cylinder_geometry(m, k, -1).lever, 0);
  const CylinderLimits curl = cylinder_limits(m, k, -1);
  EXPECT_GT(curl.torque_negative, curl.torque_positive);
  EXPECT_LT(curl.speed_negative, curl.speed_positive);
}

TEST(CylinderMap, RefusesImpossibleGeometry) {
  const scene::Machine m = arm_with_bucket();
  scene::Cylinder c = direct();
  c.joint = "nothing";
  EXPECT_THROW(CylinderMap(m, c), InputError);
  c = direct();
  c.rod_link = "stick";
  EXPECT_THROW(CylinderMap(m, c), InputError);
  c = linked();
  c.coupler = 0.2;  // too short to reach
  EXPECT_THROW(CylinderMap(m, c), InputError);
  c = direct();
  c.rod = c.bore;
  EXPECT_THROW(CylinderMap(m, c), InputError);
}

}  // namespace
}  // namespace navvy::vehicle
