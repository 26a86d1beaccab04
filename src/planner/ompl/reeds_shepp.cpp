// SPDX-License-Identifier: Apache-2.0
#include "planner/ompl/reeds_shepp.h"

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace navvy::planner {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using control::Path;
using control::PathPiece;
using control::PlanePose;
using Space = ob::ReedsSheppStateSpace;

// Distance between checked poses [m].
constexpr double kStep = 0.15;
// The next four are tuned: PathPlanner.GoesAroundATrenchAndTurnsInANarrowPlace. A pair of trees
// that has not met within its iterations is replaced by a new one, because growth costs more the
// larger the trees are. Largest growth of a tree at a time [m].
constexpr double kRange = 6;
// Largest number of pairs of trees.
constexpr int kTrees = 16;
// Iterations of one pair.
constexpr int kTreeIterations = 250;
// Attempts of each kind to shorten a path.
constexpr unsigned kShortenings = 60;
// Shorter pieces come from rounding [m].
constexpr double kNoPiece = 1e-6;

PlanePose pose_of(const ob::State* state) {
  const auto* s = state->as<ob::SE2StateSpace::StateType>();
  return {Vec2(s->getX(), s->getY()), s->getYaw()};
}

void set(ob::State* state, const PlanePose& pose) {
  auto* s = state->as<ob::SE2StateSpace::StateType>();
  s->setXY(pose.p.x(), pose.p.y());
  // The space takes headings from -pi up to, but not including, pi.
  const double yaw = std::remainder(pose.yaw, 2 * kPi);
  s->setYaw(yaw >= kPi ? -kPi : yaw);
}

/// Appends the pieces of the shortest path between two states to `out`.
void append(const Space& space, double radius, const ob::State* from, const ob::State* to,
            std::vector<PathPiece>& out) {
  const Space::ReedsSheppPath path = space.reedsShepp(from, to);
  for (int i = 0; i < 5; ++i) {
    const double length = path.length_[i] * radius;
    if (path.type_[i] == Space::RS_NOP || std::abs(length) < kNoPiece) continue;
    const double curvature = path.type_[i] == Space::RS_LEFT    ? 1 / radius
                             : path.type_[i] == Space::RS_RIGHT ? -1 / radius
                                                                : 0;
    // Consecutive pieces of one arc are joined.
    if (!out.empty() && out.back().curvature == curvature &&
        (out.back().length < 0) == (length < 0))
      out.back().length += length;
    else
      out.push_back({length, curvature});
  }
}

double cost(const Path& path) { return path.length() + kCuspPrice * path.cusps(); }

/// State that all searches of one problem share.
class Search {
 public:
  explicit Search(const ReedsSheppProblem& problem)
      : problem_(problem), space_(std::make_shared<Space>(problem.radius)) {
    ob::RealVectorBounds bounds(2);
    for (unsigned axis = 0; axis < 2; ++axis) {
      bounds.setLow(axis, problem.low[axis]);
      bounds.setHigh(axis, problem.high[axis]);
    }
    space_->setBounds(bounds);
    info_ = std::make_shared<ob::SpaceInformation>(space_);
    info_->setStateValidityChecker([this](const ob::State* state) {
      return space_->satisfiesBounds(state) && problem_.valid(pose_of(state));
    });
    info_->setMotionValidator(std::make_shared<ob::ReedsSheppMotionValidator>(info_));
    info_->setStateValidityCheckingResolution(kStep / space_->getMaximumExtent());
    info_->setup();
  }

  std::optional<Path> direct() const {
    ob::ScopedState<> start(space_), goal(space_);
    set(start.get(), problem_.start);
    set(goal.get(), problem_.goal);
    if (!info_->isValid(start.get()) || !info_->checkMotion(start.get(), goal.get()))
      return std::nullopt;
    std::vector<PathPiece> pieces;
    append(*space_, problem_.radius, start.get(), goal.get(), pieces);
    return Path(problem_.start, std::move(pieces));
  }

  /// Grows one pair of trees and subtracts the iterations that it used from `left`.
  std::optional<Path> grow(int& left) const {
    ob::ScopedState<> start(space_), goal(space_);
    set(start.get(), problem_.start);
    set(goal.get(), problem_.goal);
    const auto definition = std::make_shared<ob::ProblemDefinition>(info_);
    definition->setStartAndGoalStates(start, goal, 1e-9);
    og::RRTConnect trees(info_);
    trees.setRange(kRange);
    trees.setProblemDefinition(definition);
    trees.setup();
    ob::IterationTerminationCondition enough(
        static_cast<unsigned>(std::min(left, kTreeIterations)));
    const ob::PlannerStatus status =
        trees.solve(static_cast<ob::PlannerTerminationCondition>(enough));
    left -= std::max(1, static_cast<int>(enough.getTimesCalled()));
    if (status != ob::PlannerStatus::EXACT_SOLUTION) return std::nullopt;
    og::PathGeometric solution = *definition->getSolutionPath()->as<og::PathGeometric>();
    og::PathSimplifier shorter(info_);
    shorter.reduceVertices(solution, kShortenings, kShortenings);
    shorter.shortcutPath(solution, kShortenings, kShortenings);
    shorter.reduceVertices(solution, kShortenings, kShortenings);
    std::vector<PathPiece> pieces;
    for (std::size_t i = 0; i + 1 < solution.getStateCount(); ++i)
      append(*space_, problem_.radius, solution.getState(static_cast<unsigned>(i)),
             solution.getState(static_cast<unsigned>(i + 1)), pieces);
    return Path(problem_.start, std::move(pieces));
  }

 private:
  const ReedsSheppProblem& problem_;
  std::shared_ptr<Space> space_;
  ob::SpaceInformationPtr info_;
};

}  // namespace

// Several small trees cost less than a large one with the same iterations, and each may find
// another path.
std::optional<Path> plan_reeds_shepp(const ReedsSheppProblem& problem) {
  // The process has one source of seeds: no other search may draw from it until the last tree is
  // done.
  static std::mutex turns;
  const std::lock_guard<std::mutex> turn(turns);
  // Libraries never print, and OMPL would report seeding a source that was used before as a
  // mistake.
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(problem.seed);
  const Search search(problem);
  std::optional<Path> best = search.direct();
  if (best) return best;
  if (!problem.valid(problem.start) || !problem.valid(problem.goal)) return std::nullopt;
  int left = problem.iterations;
  for (int tree = 0; tree < kTrees && left > 0; ++tree) {
    std::optional<Path> found = search.grow(left);
    // Of equal costs the first path is kept.
    if (found && (!best || cost(*found) < cost(*best))) best = std::move(found);
  }
  return best;
}

}  // namespace navvy::planner
