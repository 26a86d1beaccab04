// SPDX-License-Identifier: Apache-2.0
// The clear step as a scene describes it; clear_reach.cpp checks its targets, clearing.h carries it
// out.
#include "control/activities/dig/clear.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "control/activities/dig/clearing.h"
#include "control/reach.h"
#include "scene/polygon.h"

namespace navvy::control {
namespace {

// Least distance of the dump from the polygon's edges, so that bodies do not roll back [m].
constexpr double kAsideOfArea = 1;

/// Returns the distance of `p` from the nearest edge of a polygon [m].
double distance_from_edge(const std::vector<Vec2>& polygon, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], along = polygon[(i + 1) % polygon.size()] - a;
    const double share = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - a - share * along).norm());
  }
  return least;
}

}  // namespace

void Clear::describe(scene::Fields& f) {
  f("polygon_m", polygon_numbers, {-1e6, 1e6},
    "Coordinates x y in W of the 3 to 1000 corners of the area; edges must not cross.",
    scene::kNeeded);
  f("dump_at_m", dump_at, {-1e6, 1e6}, "Place of the bodies in W.", scene::kNeeded);
  f("dump_height_m", dump_height, {0.1, 10}, "Height of the tip over the ground there.");
  f("depth_m", depth, {0.02, 0.5}, "Depth of the bucket's edge below the ground on the first try.");
  f("tolerance_m", tolerance, {0.3, 20},
    "Distance from dump_at_m within which a body counts as cleared.");
  f("tries", tries, {1, 100}, "Largest number of scoops for one body.");
}

void Clear::check(const scene::StepSource& source) {
  const scene::Machine* machine = source.machine;
  const bool can = machine && !machine->buckets.empty() && !machine->arm.boom.empty() &&
                   !machine->arm.stick.empty() && !machine->arm.bucket.empty();
  source.require(can,
                 "clear needs a machine with <navvy:bucket> and <navvy:arm> (boom, stick, bucket)");
  source.on_site("dump_at_m", dump_at);
  if (!source.has("polygon_m")) return;
  if (const std::optional<scene::PolygonFault> fault =
          scene::polygon_of(polygon_numbers, polygon)) {
    source.error("polygon_m", fault->value, fault->rule, fault->remedy);
    return;
  }
  for (const Vec2& corner : polygon) source.on_site("polygon_m", corner);
  if (!source.has("dump_at_m")) return;
  if (scene::contains(polygon, dump_at))
    source.error("dump_at_m", source.written("dump_at_m"), "must be outside polygon_m",
                 "choose a place at least " + metres(kAsideOfArea) + " beside the area");
  else if (distance_from_edge(polygon, dump_at) < kAsideOfArea)
    source.error("dump_at_m", source.written("dump_at_m"),
                 "must be at least " + metres(kAsideOfArea) + " outside polygon_m",
                 "choose a place farther away, or bodies roll back");
}

std::vector<Vec2> Clear::places() const {
  std::vector<Vec2> out = polygon;
  out.push_back(dump_at);
  return out;
}

std::unique_ptr<Activity> Clear::activity(OperatorContext& place) const {
  return std::make_unique<Clearing>(place, *this);
}

}  // namespace navvy::control
