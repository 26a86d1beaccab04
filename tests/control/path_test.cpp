// SPDX-License-Identifier: Apache-2.0
// Paths as closed forms, and the law that follows them on a bicycle that rolls without slip.
#include "control/path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "control/bicycle.h"
#include "control/ew180_like.h"
#include "control/path_follower.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "values.h"

namespace navvy::control::testing {
namespace {

TEST(Path, EndsWhereItsArcsEnd) {
  // A quarter to the left, a straight line, a quarter to the left backwards: closed forms by hand.
  const Path path({Vec2(1, 2), 0}, {{kPi, 0.5}, {3, 0}, {-kPi, 0.5}});
  EXPECT_NEAR(path.length(), 2 * kPi + 3, 1e-12);
  const PlanePose bend = path.at(kPi);
  EXPECT_NEAR((bend.p - Vec2(3, 4)).norm(), 0, 1e-12);
  EXPECT_NEAR(bend.yaw, kPi / 2, 1e-12);
  const PlanePose end = path.at(path.length());
  // From (3, 7) facing north, backwards on a circle about (1, 7).
  EXPECT_NEAR((end.p - Vec2(1, 5)).norm(), 0, 1e-12);
  EXPECT_NEAR(end.yaw, 0, 1e-12);
  // Beyond its ends it stays at the end pose.
  EXPECT_NEAR((path.at(1000).p - end.p).norm(), 0, 1e-12);
  EXPECT_NEAR((path.at(-1).p - Vec2(1, 2)).norm(), 0, 1e-12);
}

TEST(Path, HasALegForEachDirection) {
  const Path path({Vec2(0, 0), 0}, {{2, 0.1}, {1, 0}, {0, 0.1}, {-4, -0.1}, {5, 0}});
  ASSERT_EQ(path.legs().size(), 3u);
  EXPECT_EQ(path.cusps(), 2);
  EXPECT_DOUBLE_EQ(path.legs()[1].begin, 3);
  EXPECT_DOUBLE_EQ(path.legs()[1].end, 7);
  EXPECT_EQ(path.legs()[1].sense, -1);
  // The mean over a stretch is limited to the leg; at a point it is that of the piece.
  EXPECT_NEAR(path.curvature(path.legs()[0], 2, 0.5), 0.05, 1e-12);
  EXPECT_NEAR(path.curvature(path.legs()[0], 3, 0.5), 0, 1e-12);
  EXPECT_NEAR(path.curvature(path.legs()[1], 3, 0), -0.1, 1e-12);
  EXPECT_EQ(Path().length(), 0);
}

TEST(Path, IsRestoredFromASnapshotAndRefusesOneWithoutEnd) {
  Path path({Vec2(1, 2), 3}, {{2, 0.1}, {-1, 0}}), back;
  load_saved(saved(path), back);
  EXPECT_EQ(hash_of(back).digest(), hash_of(path).digest());
  EXPECT_EQ(back.cusps(), 1);
  Path endless({Vec2(0, 0), 0}, {{std::numeric_limits<double>::infinity(), 0}});
  EXPECT_THROW(load_saved(saved(endless), back), InputError);
}

/// Largest distance from the path, and the bicycle at its end.
struct Followed {
  Bicycle bicycle;
  double aside = 0;  // [m]
  double time = 0;
};

/// Follows from `start`, beside the path's own start: each leg begins at rest, with the wheels
/// turned before.
Followed follow(const Path& path, const PlanePose& start, double speed) {
  const PathFollower law(ew180_like().drive);
  Followed out;
  out.bicycle.at = start;
  double s = 0;
  for (const PathLeg& leg : path.legs()) {
    out.bicycle.steer = law.steer_at_start(path, leg);
    out.bicycle.speed = 0;
    double v = 0;
    for (; out.time < 500; out.time += Bicycle::kStep) {
      const PathPlace place = law.place(path, leg, out.bicycle.at, s);
      s = place.s;
      out.aside = std::max(out.aside, std::abs(place.aside));
      if (leg.end - s < kStopShort) break;
      v = std::min({speed, v + kDriveAcceleration * Bicycle::kStep, law.speed_limit(path, leg, s)});
      out.bicycle.step({leg.sense * v, law.steer(path, leg, place), false});
    }
  }
  return out;
}

TEST(PathFollower, EndsAtTheGoalForwardsBackwardsAndOverCusps) {
  // Bends as in plans, 1.2 times as wide as the tightest: left, straight, right, then backwards,
  // then forwards.
  const double k = 1 / (kRadiusReserve * PathFollower(ew180_like().drive).least_radius());
  const std::vector<Path> paths = {
      Path({Vec2(0, 0), 0.3}, {{6, k}, {4, 0}, {6, -k}}),
      Path({Vec2(0, 0), 0.3}, {{-6, k}, {-4, 0}, {-6, -k}}),
      Path({Vec2(0, 0), 3.0}, {{5, k}, {5, -k}, {-7, k}, {-3, 0}, {8, -k}, {2, 0}}),
  };
  double most = 0, goal_distance = 0;
  for (const Path& path : paths)
    for (const double speed : {0.5, 1.0, 1.5}) {
      const Followed run = follow(path, path.start(), speed);
      const PlanePose end = path.at(path.length());
      most = std::max(most, run.aside);
      goal_distance = std::max(goal_distance, (run.bicycle.at.p - end.p).norm());
      // From one lock to the other at 0.55 m/s; starting from rest, the drive's lag and creeping
      // cost only seconds.
      EXPECT_LT(run.time, path.length() / std::min(speed, 0.55) +
                              12.0 * static_cast<double>(path.legs().size()))
          << speed;
      EXPECT_LT(std::abs(std::remainder(run.bicycle.at.yaw - end.yaw, 2 * kPi)), radians(3))
          << speed;
    }
  print_value("largest distance from the path [m]", most, "<= 0.03", "a bicycle");
  print_value("largest distance from the goal [m]", goal_distance, "<= 0.12", "a bicycle");
  EXPECT_LT(most, 0.03);  // a plan keeps 0.2 m more than the required clearance
  EXPECT_LT(goal_distance, 0.12);
}

TEST(PathFollower, ReturnsToItsPath) {
  const Path ahead({Vec2(0, 0), 0}, {{15, 0}}), back({Vec2(0, 0), 0}, {{-15, 0}});
  for (const Path* path : {&ahead, &back}) {
    const Followed run = follow(*path, {Vec2(0, 0.15), radians(4)}, 1);
    EXPECT_LT(std::abs(run.bicycle.at.p.y()), 0.01);  // ten lengths of its fading of 1.3 m
    EXPECT_LT(std::abs(run.bicycle.at.yaw), radians(0.5));
  }
}

}  // namespace
}  // namespace navvy::control::testing
