// SPDX-License-Identifier: Apache-2.0
#include "planner/map_path_planner.h"

#ifdef NAVVY_WITH_OMPL

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "control/path_follower.h"
#include "map/map_maker.h"
#include "map/map_sources.h"
#include "planner/footprint.h"
#include "planner/obstacle_index.h"
#include "planner/ompl/reeds_shepp.h"

namespace navvy::planner {
namespace {

// Clearance that the search adds to the requested one [m]: a machine deviates a little from its
// path, and poses between two checked ones come a little nearer. tuned:
// GoToStep.DrivesAroundATrenchDugAfterPlanning
constexpr double kReserve = 0.2;

// Amount by which a machine that leaves an obstacle may come nearer to it than where it stands [m]:
// columns are square, so the clearance of a path beside them varies.
constexpr double kNearer = 0.01;

class MapPathPlanner final : public control::PathPlanner {
 public:
  explicit MapPathPlanner(const scene::Machine& machine)
      : maker_({{map::MapLayer::kTraversability}, map::limits_of(machine), {}}),
        footprint_(footprint_of(machine)),
        radius_(control::kRadiusReserve * control::PathFollower(machine.drive).least_radius()) {}

  void look(const control::SurfaceView& surface) override {
    maker_.update(surface.mapped());
    map_ = maker_.map();
  }

  double clearance(const control::PlanePose& at, double range) const override {
    return planner::clearance(*map_, footprint_, at.p.x(), at.p.y(), at.yaw, range);
  }

  double length() const override { return footprint_.front + footprint_.rear; }

  std::optional<control::Path> plan(const control::PathQuery& query) const override {
    const ObstacleIndex index(*map_);
    // The reserve is dropped where start or goal are nearer to obstacles than that, or the passage
    // is too narrow.
    for (const double reserve : {kReserve, 0.0})
      for (const double near : clearances_near(query, query.clearance + reserve))
        if (std::optional<control::Path> path =
                search(query, index, query.clearance + reserve, near);
            path && keeps_clearance(*this, *path, 0, query.clearance))
          return path;
    const double near = control::clearance_near(*this, query.start, query.clearance);
    return near < query.clearance ? leave_straight(query, index, near) : std::nullopt;
  }

 private:
  /// Returns the clearances near the start with which paths that otherwise keep `wanted` [m] are
  /// searched for, one after the other.
  std::vector<double> clearances_near(const control::PathQuery& query, double wanted) const {
    const double here = clearance(query.start, query.clearance);
    const double least = control::clearance_near(*this, query.start, query.clearance);
    if (least == query.clearance) return {wanted};
    if (here - kNearer <= least) return {least};
    // First a path on which the machine comes no nearer to the obstacle.
    return {here - kNearer, least};
  }

  /// Returns a path that begins straight, ahead or back, until the obstacles at the start are out
  /// of reach: beside a wall that is too near to turn, the search finds none.
  std::optional<control::Path> leave_straight(const control::PathQuery& query,
                                              const ObstacleIndex& index, double near) const {
    constexpr double kStep = 0.1;  // [m]
    const Vec2 ahead(std::cos(query.start.yaw), std::sin(query.start.yaw));
    for (const double reserve : {kReserve, 0.0})
      for (const double sense : {1.0, -1.0}) {
        const double wanted = query.clearance + reserve;
        control::PathQuery rest = query;
        double length = 0;
        while (control::is_near(*this, rest.start, query.start) && keeps(index, rest.start, near) &&
               !keeps(index, rest.start, wanted)) {
          length += sense * kStep;
          rest.start.p = query.start.p + length * ahead;
        }
        if (!keeps(index, rest.start, wanted)) continue;
        const std::optional<control::Path> path = search(rest, index, wanted, wanted);
        if (!path) continue;
        std::vector<control::PathPiece> pieces = path->pieces();
        pieces.insert(pieces.begin(), {length, 0});
        control::Path whole(query.start, std::move(pieces));
        if (keeps_clearance(*this, whole, 0, query.clearance)) return whole;
      }
    return std::nullopt;
  }

  /// Returns true if the clearance of a pose is at least `least` [m].
  bool keeps(const ObstacleIndex& index, const control::PlanePose& at, double least) const {
    return index.surely_clear(footprint_, at.p.x(), at.p.y(), at.yaw, least) ||
           clearance(at, least) >= least;
  }

  /// Searches a path whose poses keep `wanted` [m], and `near` [m] near the start.
  std::optional<control::Path> search(const control::PathQuery& query, const ObstacleIndex& index,
                                      double wanted, double near) const {
    ReedsSheppProblem problem;
    problem.start = query.start;
    problem.goal = query.goal;
    problem.radius = radius_;
    problem.low = map_->origin();
    problem.high = map_->origin() + map_->cell() * Vec2(map_->nx(), map_->ny());
    problem.iterations = query.iterations;
    problem.seed = query.seed;
    problem.valid = [&](const control::PlanePose& at) {
      return keeps(index, at, control::is_near(*this, at, query.start) ? near : wanted);
    };
    // The goal keeps the whole clearance, also near the start.
    if (!problem.valid(query.start) || !keeps(index, query.goal, wanted)) return std::nullopt;
    return plan_reeds_shepp(problem);
  }

  map::MapMaker maker_;
  std::optional<map::TerrainMap> map_;
  Footprint footprint_;
  double radius_;
};

}  // namespace

control::MakePathPlanner path_planners() {
  return [](const scene::Machine& machine) { return std::make_unique<MapPathPlanner>(machine); };
}

}  // namespace navvy::planner

#else

namespace navvy::planner {

control::MakePathPlanner path_planners() { return {}; }

}  // namespace navvy::planner

#endif
