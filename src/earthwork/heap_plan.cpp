// SPDX-License-Identifier: Apache-2.0
#include "earthwork/heap_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "control/reach.h"
#include "earthwork/cut_fan.h"
#include "earthwork/spoil_place.h"
#include "earthwork/station_search.h"

namespace navvy::earthwork {
namespace {

using control::metres;
using control::place_text;

// A heap is dug in this sector, to both sides of straight ahead [rad].
constexpr double kHeapSector = radians(150);
// Least volume of a cut above the lowest layer / heaped capacity: buckets that go into trucks come
// from where there is more than a load, which a heap's top has not; hollows take what there is.
constexpr double kFullLoads = 1.2, kShares = 0.6;

/// Returns the corners of the strip of a heap.
scene::DesignArea heap_area(const control::JobHeap& heap) {
  const Vec2 line = heap.to - heap.from;
  const Vec2 along =
      0.5 * heap.width * (line.norm() > 1e-6 ? Vec2(line.normalized()) : Vec2::UnitX());
  const Vec2 across(-along.y(), along.x());
  scene::DesignArea out;
  out.polygon = {heap.from - along - across, heap.to + along - across, heap.to + along + across,
                 heap.from - along + across};
  return out;
}

}  // namespace

PitShape heap_shape(const control::JobHeap& heap, const control::SurfaceView& surface) {
  PitShape out(heap_area(heap), surface);
  out.cover_heap(kHeapSkin);
  return out;
}

double heap_volume(const PitShape& heap) {
  double out = 0;
  for (const PitColumn& one : heap.columns())
    out += std::max(0.0, one.top - one.floor) * heap.column_area();
  return out;
}

std::vector<Vec2> heap_points(const control::JobHeap& heap) {
  control::PitJob line;
  line.dump_from = heap.from;
  line.dump_to = heap.to;
  return spoil_points(line);
}

bool reaches_heap(const std::vector<Vec2>& points, const Vec2& centre, double yaw, double most) {
  return std::any_of(points.begin(), points.end(), [&](const Vec2& p) {
    const Vec2 line = p - centre;
    const double turn = std::remainder(std::atan2(line.y(), line.x()) - yaw, 2 * kPi);
    return line.norm() <= most && line.norm() >= kFaceBegins && std::abs(turn) <= kHeapSector;
  });
}

std::vector<control::JobCut> heap_cuts(const control::PitJob& job, const PitShape& heap,
                                       const ArmReach& reach, const Pose& X_WB,
                                       const control::SurfaceView& surface) {
  control::PitJob scoops = job;
  scoops.tolerance = 0;
  scoops.area.depth = heap.ground() - heap.lowest();
  return cut_fan(scoops, heap, reach, X_WB, surface,
                 {kHeapSector, false, job.into_beds ? kFullLoads : kShares});
}

control::JobPlan plan_loading(const control::PitJob& job, const ArmReach& reach, const Pose& X_WB,
                              const control::SurfaceView& surface) {
  control::JobPlan out;
  const PitShape heap = heap_shape(*job.heap, surface);
  const Pose X_WS = X_WB * reach.arm().X_BS();
  const Vec2 centre = X_WS.translation().head<2>();
  control::JobStation station;
  station.at = control::plane_pose(X_WB);
  station.volume = out.volume = heap_volume(heap);
  station.cuts =
      static_cast<std::int64_t>(std::ceil(station.volume / reach.arm().bucket().capacity));
  out.stations.push_back(station);
  const double most = reach.at(heap.lowest() - X_WS.translation().z()).most;
  if (!reaches_heap(heap_points(*job.heap), centre, station.at.yaw, most))
    out.faults.push_back(
        {"from_m", place_text(job.heap->from),
         "from where the machine stands, with its swing axis at " + place_text(centre) +
             ", no soil of the heap is within reach",
         "stand at most " + metres(most) + " from it, with the heap ahead or beside"});
  if (reachable_spoil(job, reach.arm(), X_WS, surface).empty())
    out.faults.push_back({"dump_at_m", place_text(job.dump_from),
                          "the bucket cannot be opened over the beds from there",
                          "let the trucks stand nearer, or lower dump_height_m"});
  return out;
}

control::JobVolume loading_volume(const control::PitJob& job, const control::SurfaceView& surface) {
  control::JobVolume out;
  out.design = out.left = heap_volume(heap_shape(*job.heap, surface));
  return out;
}

}  // namespace navvy::earthwork
