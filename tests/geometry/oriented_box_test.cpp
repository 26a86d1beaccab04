// SPDX-License-Identifier: Apache-2.0
#include "geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <cmath>

namespace navvy::geometry {
namespace {

TEST(OrientedBox, ReportsPenetrationAndGap) {
  const OrientedBox unit{Pose::Identity(), Vec3(0.5, 0.5, 0.5)};
  EXPECT_NEAR(penetration(unit, {make_pose(0.8, 0, 0, 0, 0, 0), Vec3(0.5, 2, 2)}), 0.2, 1e-12);
  EXPECT_NEAR(penetration(unit, {make_pose(1.5, 0, 0, 0, 0, 0), unit.half}), -0.5, 1e-12);
  // Turned by 45 deg its corner is sqrt(0.5) ahead.
  EXPECT_NEAR(penetration(unit, {make_pose(1.1, 0, 0, 0, 0, radians(45)), unit.half}),
              0.5 + std::sqrt(0.5) - 1.1, 1e-12);
}

TEST(OrientedBox, FindsAGapBetweenCrossedEdges) {
  // Two square rods, each on its edge, crossed at right angles: their edges face each other.
  const double edge = 0.1;
  const OrientedBox along{make_pose(0, 0, 0, radians(45), 0, 0), Vec3(5, edge, edge)};
  const double reach = std::sqrt(2.0) * edge;
  for (const double gap : {0.01, -0.01}) {
    const OrientedBox across{Pose(make_pose(0, 0, 2 * reach + gap, 0, 0, radians(90)) *
                                  make_pose(0, 0, 0, radians(45), 0, 0)),
                             Vec3(5, edge, edge)};
    EXPECT_NEAR(penetration(along, across), -gap, 1e-9);
  }
}

}  // namespace
}  // namespace navvy::geometry
