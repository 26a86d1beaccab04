// SPDX-License-Identifier: Apache-2.0
#include "planner/map_path_planner.h"

#ifdef NAVVY_WITH_OMPL

#include <memory>
#include <utility>

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

  std::optional<control::Path> plan(const control::PathQuery& query) const override {
    ReedsSheppProblem problem;
    problem.start = query.start;
    problem.goal = query.goal;
    problem.radius = radius_;
    problem.low = map_->origin();
    problem.high = map_->origin() + map_->cell() * Vec2(map_->nx(), map_->ny());
    problem.iterations = query.iterations;
    problem.seed = query.seed;
    const ObstacleIndex index(*map_);
    double wanted = 0;
    problem.valid = [&](const control::PlanePose& at) {
      return index.surely_clear(footprint_, at.p.x(), at.p.y(), at.yaw, wanted) ||
             clearance(at, wanted) >= wanted;
    };
    // The reserve is dropped where start or goal are nearer to obstacles than that, or the passage
    // is too narrow.
    for (const double reserve : {kReserve, 0.0}) {
      wanted = query.clearance + reserve;
      if (!problem.valid(query.start) || !problem.valid(query.goal)) continue;
      std::optional<control::Path> path = plan_reeds_shepp(problem);
      if (path &&
          clearance_along(*this, *path, 0, query.clearance, query.clearance) >= query.clearance)
        return path;
    }
    return std::nullopt;
  }

 private:
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
