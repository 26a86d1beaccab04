// SPDX-License-Identifier: Apache-2.0
#include "control/arm_kinematics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/ew180_like.h"
#include "core/error.h"
#include "vehicle/kinematics.h"

namespace navvy::control {
namespace {

TEST(ArmKinematics, ForwardAgreesWithTheTreesKinematics) {
  const scene::Machine machine = testing::ew180_like();
  const ArmKinematics arm(machine);
  const ArmAngles q{0.4, -1.7, -0.9};
  const auto links = vehicle::forward_kinematics(machine, Pose::Identity(), {0, q[0], q[1], q[2]});
  const Vec3 tip = links[4] * machine.buckets[0].p_tip - Vec3(1.25, 0, 1.18);
  const BucketPose pose = arm.forward(q);
  EXPECT_NEAR(pose.reach, tip.x(), 1e-12);  // same closed form, rounding only
  EXPECT_NEAR(pose.height, tip.z(), 1e-12);
  EXPECT_NEAR(pose.angle, q[0] + q[1] + q[2], 1e-12);
}

TEST(ArmKinematics, SwingInertiaIsThatOfTheLinks) {
  const scene::Machine machine = testing::ew180_like();
  const ArmKinematics arm(machine);
  for (const ArmAngles& q : {ArmAngles{0.4, -1.7, -0.9}, ArmAngles{-0.3, -0.8, 0.2}}) {
    const auto links =
        vehicle::forward_kinematics(machine, Pose::Identity(), {0, q[0], q[1], q[2]});
    const Vec3 axis = (machine.links[0].X_ML.inverse() * arm.X_BS()).translation();
    double sum = 0;
    for (const char* name : {"upper", "boom", "stick", "bucket"}) {
      const auto k = static_cast<std::size_t>(machine.link_index(name));
      const Mat3 R = links[k].linear();
      const Vec3 p = links[k] * machine.links[k].p_LCom - axis;
      sum += (R * machine.links[k].inertia * R.transpose())(2, 2) +
             machine.links[k].mass * p.head<2>().squaredNorm();
    }
    EXPECT_NEAR(arm.swing_inertia(q, 0), sum, 1e-9 * sum);  // the same sums, rounding only
    // 500 kg halfway between pin and tip.
    const BucketPose tip = arm.forward(q);
    const double middle = tip.reach - 0.5 * arm.bucket_length() * std::cos(tip.angle);
    EXPECT_NEAR(arm.swing_inertia(q, 500) - sum, 500 * middle * middle, 1e-9 * sum);
  }
}

TEST(ArmKinematics, StruckCapacityIsTheVolumeUpToTheMouth) {
  // A prism 1.05 m wide: the profile's area by the formula for polygons. The sides are added here.
  scene::Machine machine = testing::ew180_like();
  for (int k = 1; k < 8; ++k) {
    machine.shells[0].triangles.push_back({0, k, k + 1});
    machine.shells[0].triangles.push_back({9, k + 10, k + 9});
  }
  const auto& v = machine.shells[0].vertices;
  double area = 0;
  for (std::size_t k = 0; k < 9; ++k) {
    const Vec3 a = v[k], b = v[(k + 1) % 9];
    area += 0.5 * (a.x() * b.z() - b.x() * a.z());
  }
  EXPECT_NEAR(ArmKinematics(machine).struck_capacity(), 1.05 * std::abs(area), 1e-12);
}

TEST(ArmKinematics, InverseReproducesEveryForwardPose) {
  const ArmKinematics arm(testing::ew180_like());
  int tried = 0;
  for (double boom = -0.8; boom <= 1.0; boom += 0.15)
    for (double stick = -2.7; stick <= -0.65; stick += 0.2)
      for (double bucket = -2.5; bucket <= 0.35; bucket += 0.3) {
        const BucketPose pose = arm.forward({boom, stick, bucket});
        ArmAngles q;
        ASSERT_TRUE(arm.inverse(pose, q)) << boom << " " << stick << " " << bucket;
        EXPECT_NEAR(q[0], boom, 1e-7);  // acos near its ends loses half the digits
        EXPECT_NEAR(q[1], stick, 1e-7);
        EXPECT_NEAR(q[2], bucket, 1e-7);
        ++tried;
      }
  EXPECT_GT(tried, 1000);
}

TEST(ArmKinematics, InverseRefusesPosesOutOfReachAndNearestTurnsTheBucket) {
  const ArmKinematics arm(testing::ew180_like());
  ArmAngles q;
  BucketPose far{12, 0, -kPi / 2};
  EXPECT_FALSE(arm.inverse_nearest(far, q));
  // Out of reach for a bucket pointing down, reachable with it stretched out.
  BucketPose pose{7.9, -1.2, -kPi / 2};
  EXPECT_FALSE(arm.inverse(pose, q));
  ASSERT_TRUE(arm.inverse_nearest(pose, q));
  EXPECT_GT(pose.angle, -kPi / 2);
  EXPECT_NEAR(arm.forward(q).reach, 7.9, 1e-9);
}

TEST(ArmKinematics, NearestMovesSmoothlyAlongALimit) {
  const ArmKinematics arm(testing::ew180_like());
  ArmAngles before{};
  bool first = true;
  double most = 0;
  // Along the floor of a trench from far out: the preferred digging angle is possible only nearby.
  for (double reach = 7.8; reach > 4.4; reach -= 0.004) {
    BucketPose pose{reach, -1.98, -radians(112)};
    ArmAngles q;
    ASSERT_TRUE(arm.inverse_nearest(pose, q)) << reach;
    for (std::size_t i = 0; i < 3; ++i)
      if (!first) most = std::max(most, std::abs(q[i] - before[i]));
    first = false;
    before = q;
  }
  // 4 mm of tip path turn the bucket by 5 mrad on average; steps of 2 deg would be 35 mrad.
  EXPECT_LT(most, 0.02);
}

TEST(ArmKinematics, ShellHangsBelowTheTipOnlyWhenTheBucketIsCurled) {
  const ArmKinematics arm(testing::ew180_like());
  // Digging: the floor plate rises behind the edge.
  EXPECT_NEAR(arm.below_tip(-radians(112)), 0, 1e-12);
  EXPECT_NEAR(arm.below_tip(-radians(180)), 0.63, 1e-9);  // level: the heel of the profile
  // Upright cutting edge: no part of the bucket's heel is farther out than the tip; curled in, the
  // heel is. 3 deg over the plate's 0.31 m
  EXPECT_NEAR(arm.beyond_tip(-radians(93) - arm.cut_angle(), 0.8), 0, 0.02);
  EXPECT_GT(arm.beyond_tip(-radians(130), 0.8), 0.5);
  EXPECT_LT(arm.beyond_tip(-radians(130), 0.1), arm.beyond_tip(-radians(130), 0.4));
}

TEST(ArmKinematics, NamesTheRoleThatIsMissing) {
  scene::Machine machine = testing::ew180_like();
  machine.arm.stick.clear();
  try {
    const ArmKinematics arm(machine);
    FAIL() << "a machine without a stick was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("stick"), std::string::npos);
  }
}

}  // namespace
}  // namespace navvy::control
