// SPDX-License-Identifier: Apache-2.0
#include "session/bucket_gauge.h"

#include <gtest/gtest.h>

namespace navvy::session {
namespace {

TEST(BucketGauge, SplitsAForceByTheMotionOfTheEdge) {
  // The link turns about its origin at 1 rad/s with the cutting edge 1.5 m ahead of it, which
  // therefore moves straight down.
  vehicle::LinkState link;
  link.w_WL = Vec3(0, 1, 0);
  const Vec3 p_tip(1.5, 0, 0);
  const BucketLoad load = load_of(Vec3(3000, 0, 4000), link, p_tip);
  EXPECT_DOUBLE_EQ(load.whole, 5000);
  EXPECT_DOUBLE_EQ(load.draft, 4000);
  EXPECT_DOUBLE_EQ(load.uplift, 4000);

  // A force along the motion of the edge is no draft, and a load is no uplift.
  const BucketLoad carried = load_of(Vec3(0, 0, -4000), link, p_tip);
  EXPECT_DOUBLE_EQ(carried.draft, 0);
  EXPECT_DOUBLE_EQ(carried.uplift, 0);
}

TEST(BucketGauge, HasNoDraftAtAnEdgeAtRest) {
  vehicle::LinkState link;
  link.v_WL = Vec3(0.04, 0, 0);
  const BucketLoad load = load_of(Vec3(-1000, 0, 0), link, Vec3(1.5, 0, 0));
  EXPECT_DOUBLE_EQ(load.whole, 1000);
  EXPECT_DOUBLE_EQ(load.draft, 0);
}

TEST(BucketGauge, TurnsTheEdgeWithItsLink) {
  // Upright link: its x axis points up, so that a rotation about y moves the edge along W's x.
  vehicle::LinkState link;
  link.X_WL.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  link.w_WL = Vec3(0, 2, 0);
  EXPECT_NEAR(load_of(Vec3(-700, 0, 0), link, Vec3(1, 0, 0)).draft, 700, 1e-9);
}

}  // namespace
}  // namespace navvy::session
