// SPDX-License-Identifier: Apache-2.0
// Paths around ground that an excavator cannot drive on. Skipped, visibly, in a build without OMPL.
#include "planner/map_path_planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "control/path_follower.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "planner/footprint.h"
#include "planner/obstacle_index.h"
#include "planner/sites.h"
#include "values.h"

namespace navvy::planner {
namespace {

using control::GroundSurfaceView;
using control::Path;
using control::PathQuery;
using testing::dig;
using testing::excavator;
using testing::fill;
using testing::level_site;

constexpr double kClearance = 0.3;  // [m]

PathQuery query(double x0, double x1, double yaw1 = 0) {
  PathQuery out;
  out.start = {Vec2(x0, 0), 0};
  out.goal = {Vec2(x1, 0), yaw1};
  out.clearance = kClearance;
  return out;
}

std::uint64_t digest(Path path) { return hash_of(path).digest(); }

/// Returns the least clearance, sampled every 2 cm on a fully computed map.
double least_clearance(const heightfield::Ground& ground, const Path& path) {
  map::MapOptions options;
  options.layers = {map::MapLayer::kTraversability};
  map::MapMaker maker(options);
  maker.update(ground.view());
  const map::TerrainMap map = maker.map();
  const Footprint footprint = footprint_of(excavator());
  double least = 10;
  for (double s = 0; s <= path.length() + 0.02; s += 0.02) {
    const control::PlanePose at = path.at(s);
    least = std::min(least, clearance(map, footprint, at.p.x(), at.p.y(), at.yaw, 1));
  }
  return least;
}

void expect_drivable(const Path& path, const PathQuery& asked) {
  const control::PlanePose end = path.at(path.length());
  EXPECT_LT((end.p - asked.goal.p).norm(), 1e-6);
  EXPECT_LT(std::abs(std::remainder(end.yaw - asked.goal.yaw, 2 * kPi)), 1e-6);
  const double tightest = control::PathFollower(excavator().drive).least_radius();
  for (const control::PathPiece& piece : path.pieces())
    EXPECT_LT(std::abs(piece.curvature), 1 / (1.15 * tightest));
}

TEST(Footprint, MatchesTheExcavatorsFile) {
  const Footprint f = footprint_of(excavator());
  EXPECT_NEAR(f.front, 1.5 + 2.3, 1e-9);                // the chassis' body
  EXPECT_NEAR(f.rear, 2.3 - 1.5, 1e-9);                 //
  EXPECT_NEAR(f.left, 0.97 + (0.28 + 0.32) / 2, 1e-9);  // twin tyres
  EXPECT_NEAR(f.right, f.left, 1e-9);
}

TEST(ObstacleIndex, NeverReportsAnOccupiedPlaceAsClear) {
  heightfield::Ground ground = level_site();
  dig(ground, Vec2(-1, -2), Vec2(1.5, 5));
  dig(ground, Vec2(6, 6), Vec2(6.2, 6.2));
  map::MapOptions options;
  options.layers = {map::MapLayer::kTraversability};
  map::MapMaker maker(options);
  maker.update(ground.view());
  const map::TerrainMap map = maker.map();
  const ObstacleIndex index(map);
  const Footprint footprint = footprint_of(excavator());
  Random random(3);
  int clear = 0, reported = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform() * 40 - 20, y = random.uniform() * 28 - 14,
                 yaw = random.uniform() * 7;
    const bool is = clearance(map, footprint, x, y, yaw, 0.4) >= 0.4;
    const bool says = index.surely_clear(footprint, x, y, yaw, 0.4);
    ASSERT_TRUE(is || !says) << x << " " << y << " " << yaw;
    clear += is, reported += says;
  }
  // Places that the index leaves undecided are queried in the map itself: few enough to be
  // worthwhile.
  print_value("share of clear places that the index reports", static_cast<double>(reported) / clear,
              "> 0.6", "20 000 poses");
  EXPECT_GT(reported, 0.6 * clear);
}

class PathPlanner : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!path_planners())
      GTEST_SKIP() << "no OMPL in this build: install libompl-dev and build with NAVVY_WITH_OMPL";
    planner_ = path_planners()(excavator());
  }
  std::optional<Path> plan(const heightfield::Ground& ground, const PathQuery& asked) {
    planner_->look(GroundSurfaceView(ground));
    return planner_->plan(asked);
  }
  std::unique_ptr<control::PathPlanner> planner_;
};

TEST_F(PathPlanner, GoesStraightWhereNothingBlocksThePath) {
  const heightfield::Ground ground = level_site();
  const auto path = plan(ground, query(-8, 9));
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->length(), 17, 1e-9);
  EXPECT_EQ(path->cusps(), 0);
}

TEST_F(PathPlanner, GoesAroundATrenchAndTurnsInANarrowPlace) {
  heightfield::Ground ground = level_site();
  dig(ground, Vec2(-1, -2), Vec2(1.5, 5));
  for (const double yaw : {0.0, kPi, -kPi / 2}) {
    const PathQuery asked = query(-8, 9, yaw);
    const auto path = plan(ground, asked);
    ASSERT_TRUE(path) << yaw;
    expect_drivable(*path, asked);
    const double least = least_clearance(ground, *path);
    print_value("least clearance of a path around a trench [m]", least, ">= 0.3", "required");
    print_value("its length [m], cusps", path->length(), std::to_string(path->cusps()),
                "17 m straight");
    EXPECT_GE(least, kClearance);
    EXPECT_LT(path->length(), 60);
  }
}

TEST_F(PathPlanner, IsBitIdenticalWhateverWasPlannedBefore) {
  heightfield::Ground ground = level_site();
  const PathQuery asked = query(-8, 9);
  plan(ground, asked);
  dig(ground, Vec2(-1, -2), Vec2(1.5, 5));
  PathQuery other = asked;
  other.seed = 99;
  const auto elsewhere = plan(ground, other);
  const auto again = plan(ground, asked);
  const auto fresh = path_planners()(excavator());
  fresh->look(GroundSurfaceView(ground));
  const auto first = fresh->plan(asked);
  ASSERT_TRUE(elsewhere && again && first);
  EXPECT_EQ(digest(*first), digest(*again));
  EXPECT_NE(digest(*elsewhere), digest(*again)) << "the seed has no effect";
}

TEST_F(PathPlanner, IsIdenticalInParallelThreads) {
  heightfield::Ground ground = level_site();
  dig(ground, Vec2(-1, -2), Vec2(1.5, 5));
  std::vector<std::uint64_t> alone, beside(4);
  const auto one = [&ground](std::uint32_t seed) {
    const auto planner = path_planners()(excavator());
    planner->look(GroundSurfaceView(ground));
    PathQuery asked = query(-8, 9);
    asked.seed = seed;
    const auto path = planner->plan(asked);
    return path ? digest(*path) : 0;
  };
  for (std::uint32_t i = 0; i < 4; ++i) alone.push_back(one(i + 1));
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < 4; ++i) threads.emplace_back([&, i] { beside[i] = one(i + 1); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone, beside);
}

TEST_F(PathPlanner, FindsNothingIfNoPathExists) {
  heightfield::Ground ground = level_site();
  dig(ground, Vec2(-1, -13), Vec2(1.5, 13));
  PathQuery across = query(-8, 9);
  across.iterations = 300;
  EXPECT_FALSE(plan(ground, across));
  // The goal in the trench, and beyond the edge.
  EXPECT_FALSE(plan(ground, query(-8, 0)));
  EXPECT_FALSE(plan(ground, query(-8, 17)));
  EXPECT_EQ(planner_->clearance({Vec2(17, 0), 0}, 1), 0);
  // The search ends after a number of iterations: with only one it finds no detour.
  heightfield::Ground open = level_site();
  dig(open, Vec2(-1, -2), Vec2(1.5, 5));
  PathQuery hasty = query(-8, 9);
  hasty.iterations = 1;
  EXPECT_FALSE(plan(open, hasty));
}

/// Digs trenches at ever greater distances in front of an excavator at (-8, 0), or to its left, and
/// returns the first ground on which its clearance is at least `least` [m].
heightfield::Ground trench_near(control::PathPlanner& planner, bool ahead, double least) {
  for (double off = 0;; off += 0.05) {
    heightfield::Ground ground = level_site();
    if (ahead)
      dig(ground, Vec2(-4.2 + off, -4), Vec2(-2.5 + off, 4));
    else
      dig(ground, Vec2(-14, 1.27 + off), Vec2(2, 3 + off));
    planner.look(GroundSurfaceView(ground));
    if (planner.clearance({Vec2(-8, 0), 0}, 1) >= least) return ground;
  }
}

TEST_F(PathPlanner, LeavesAnObstacleThatIsNearerThanTheClearance) {
  for (const bool ahead : {true, false})
    for (const double near : {0.05, 0.15}) {
      const heightfield::Ground ground = trench_near(*planner_, ahead, near);
      PathQuery asked = query(-8, 9);
      asked.goal.p.y() = -4;
      const double here = planner_->clearance(asked.start, 1);
      ASSERT_LT(here, kClearance);
      const auto path = planner_->plan(asked);
      ASSERT_TRUE(path) << ahead << near;
      expect_drivable(*path, asked);
      EXPECT_TRUE(keeps_clearance(*planner_, *path, 0, kClearance));
      // The footprint stays free, and farther than twice its own length away the clearance holds.
      EXPECT_GT(least_clearance(ground, *path), 0);
      double least = 1;
      for (double s = 0; s < path->length(); s += 0.02)
        if (!is_near(*planner_, path->at(s), asked.start))
          least = std::min(least, planner_->clearance(path->at(s), 1));
      print_value("clearance at the start, and away from it [m]", here, std::to_string(least),
                  ">= 0.3 away from it");
      // 1 cm between samples of the planner's own check.
      EXPECT_GE(least, kClearance - 0.01);
    }
}

TEST_F(PathPlanner, ComesNoNearerToAnObstacleThatItCanLeaveStraight) {
  const heightfield::Ground ground = trench_near(*planner_, true, 0.15);
  const double here = planner_->clearance({Vec2(-8, 0), 0}, 1);
  const auto path = planner_->plan(query(-8, -12));
  ASSERT_TRUE(path);
  EXPECT_GE(least_clearance(ground, *path), here - 0.011);  // a millimetre for rounding
}

TEST_F(PathPlanner, DrivesAlongAWallThatItCannotTurnAwayFrom) {
  // Turning away at once, the rear would come nearer to the wall by 5 cm.
  heightfield::Ground ground = trench_near(*planner_, false, 0.01);
  // It ends 1.7 m behind the machine, and ahead of it.
  fill(ground, Vec2(-15, 1), Vec2(-10.5, 4));
  fill(ground, Vec2(-2.5, 1), Vec2(3, 4));
  planner_->look(GroundSurfaceView(ground));
  PathQuery asked = query(-8, 9);
  asked.start.p.y() = 0.05;
  asked.goal.p.y() = -4;
  ASSERT_NEAR(planner_->clearance(asked.start, 1), 0.03, 1e-6);
  const auto path = planner_->plan(asked);
  ASSERT_TRUE(path);
  EXPECT_GT(least_clearance(ground, *path), 0);
}

TEST_F(PathPlanner, DoesNotLeaveAnObstacleUnderItsFootprint) {
  heightfield::Ground ground = level_site();
  dig(ground, Vec2(-8, -0.5), Vec2(-7, 0.5));
  EXPECT_FALSE(plan(ground, query(-8, 9)));
  // Nor does it end nearer than the clearance, however near it starts.
  trench_near(*planner_, true, 0.05);
  PathQuery asked = query(-8, -8.1);
  ASSERT_LT(planner_->clearance(asked.goal, 1), kClearance);
  EXPECT_FALSE(planner_->plan(asked));
}

TEST_F(PathPlanner, KeepsTheClearanceAwayFromTheStart) {
  heightfield::Ground ground = level_site();
  // Beside the path, 12 m from its start.
  dig(ground, Vec2(4, 1.6), Vec2(5, 3));
  planner_->look(GroundSurfaceView(ground));
  const Path straight({Vec2(-8, 0), 0}, {{17, 0}});
  EXPECT_FALSE(keeps_clearance(*planner_, straight, 0, 0.6));
  EXPECT_TRUE(keeps_clearance(*planner_, straight, 0, 0.05));
  // Near the start of a path that begins there, the same ground does not count.
  const Path beside({Vec2(3, 0), 0}, {{-10, 0}});
  ASSERT_LT(planner_->clearance(beside.start(), 1), 0.6);
  EXPECT_TRUE(keeps_clearance(*planner_, beside, 0, 0.6));
}

}  // namespace
}  // namespace navvy::planner
