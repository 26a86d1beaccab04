// SPDX-License-Identifier: Apache-2.0
#include "earthwork/fill_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "control/reach.h"
#include "core/error.h"
#include "earthwork/cut_fan.h"
#include "earthwork/heap_plan.h"
#include "earthwork/pit_checks.h"
#include "earthwork/pit_shape.h"
#include "earthwork/spoil_place.h"
#include "earthwork/station_search.h"
#include "scene/polygon.h"

namespace navvy::earthwork {
namespace {

using control::metres;
using control::number_text;
using control::place_text;

// Length that is filled from one station [m]. With a reach of 7 to 8 m the soil beside it is within
// reach, too.
constexpr double kAdvance = 3;
// A hollow is looked at over a square of this half length [m], the spread of a bucket's load.
constexpr double kSpread = 0.5;
// No load is dumped nearer than this beyond the nearest soil that the arm digs [m]: what falls
// there too high cannot be taken off, and the machine drives over it next.
constexpr double kClear = 0.3;
constexpr double kEvery = 0.25;   // between places to dump [m]
constexpr double kHollow = 0.08;  // least volume of a hollow that is filled [m3]
// The fill is first made so much too high [m]: what is too high is taken off at the end, and
// nothing fills a hollow then.
constexpr double kOverfill = 0.03;
constexpr double kLeastScoop = 0.25;  // share of the heaped capacity
// The first station stands so much farther back, and soil that lies too high so far around the hole
// is taken off: the digging has left a mound at its near end, where the machine is to drive [m].
constexpr double kApron = 1, kBorder = 1.4;
constexpr double kLeastFault = 0.05;            // volume that is missing [m3]
constexpr std::int64_t kLevelKeys = 1'000'000;  // keys of levelling are so far from those of scoops

/// Returns the shape of the ground after filling, before anything compacts it.
scene::DesignArea loose_shape(const control::PitJob& job) {
  scene::DesignArea out = job.area;
  out.depth -= job.over;
  return out;
}

/// Hole and heap of a job on the present ground.
class Fill {
 public:
  Fill(const control::PitJob& job, const control::SurfaceView& surface)
      : hole(loose_shape(job), surface),
        heap(heap_shape(*job.heap, surface)),
        columns(hole.columns()) {
    ahead = scene::longest_edge(job.area.polygon).normalized();
    for (const PitColumn& one : columns) middle += one.p / static_cast<double>(columns.size());
  }

  PitShape hole, heap;
  std::vector<PitColumn> columns;  ///< of the hole
  Vec2 ahead = Vec2::UnitX();      ///< direction of the longest edge
  Vec2 middle = Vec2::Zero();      ///< of the hole in W [m]
};

/// Hollow in a fill.
struct Hollow {
  Vec2 p = Vec2::Zero();  ///< where to dump in W [m]
  double volume = 0;      ///< that it lacks [m3]
  double near = 0;        ///< the same, with what is nearer to the middle counting more [m3]
};

/// Returns the largest hollow of the stretch ahead of a machine into which its arm can dump.
std::optional<Hollow> largest_hollow(const Fill& fill, const control::PitJob& job,
                                     const control::ArmKinematics& arm, const Pose& X_WB,
                                     const control::SurfaceView& surface) {
  const Pose X_WS = X_WB * arm.X_BS();
  const double yaw = control::plane_pose(X_WB).yaw;
  const Vec2 centre = X_WS.translation().head<2>(), ahead(std::cos(yaw), std::sin(yaw));
  std::vector<PitColumn> open;
  for (const PitColumn& one : fill.columns) {
    const double away = (one.p - centre).dot(ahead);
    if (away >= kFaceBegins + kClear && away <= kFaceBegins + kAdvance + kClear + kSpread)
      open.push_back(one);
  }
  std::vector<Hollow> found;
  const auto every = std::max(1L, std::lround(kEvery / fill.hole.cell()));
  const Vec2 corner = fill.columns.empty() ? Vec2::Zero() : fill.columns.front().p;
  for (const PitColumn& at : open) {
    const Vec2 grid = (at.p - corner) / fill.hole.cell();
    if (std::lround(grid.x()) % every != 0 || std::lround(grid.y()) % every != 0) continue;
    Hollow one{at.p, 0, 0};
    for (const PitColumn& near : open)
      if (const double away = (near.p - at.p).cwiseAbs().maxCoeff(); away <= kSpread) {
        const double lack = (near.floor + kOverfill - near.top) * fill.hole.column_area();
        one.volume += lack;
        one.near += lack * (1 - 0.5 * (near.p - at.p).norm() / kSpread);
      }
    if (one.volume >= kHollow) found.push_back(one);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Hollow& a, const Hollow& b) { return a.near > b.near; });
  for (const Hollow& one : found)
    if (can_dump(job, arm, X_WS, one.p, control::heap_height(surface, one.p))) return one;
  return std::nullopt;
}

/// Reports a heap in the hole, one that is too small, and one that no station reaches.
void check_heap(const Fill& fill, const control::PitJob& job, const ArmReach& reach, double ring,
                const control::JobPlan& plan, double axle_ahead,
                std::vector<control::JobFault>& faults) {
  const std::vector<Vec2> points = heap_points(*job.heap);
  for (const Vec2& p : points) {
    if (!fill.hole.is_near(p, 0.5 * job.heap->width)) continue;
    faults.push_back({"from_m", place_text(p),
                      "the heap's strip, " + metres(job.heap->width) + " wide, is in the fill",
                      "take the soil farther aside, or make heap_width_m smaller"});
    break;
  }
  const double heap = heap_volume(fill.heap);
  if (plan.volume > kLeastFault && heap < plan.volume)
    faults.push_back(
        {"from_m", number_text(heap, "m3"),
         "the heap is smaller than the hole, which lacks " + number_text(plan.volume, "m3"),
         "make the heap larger, or fill less (depth_m)"});
  const double most = reach.at(fill.hole.lowest() - ring).most;
  for (std::size_t i = 0; i < plan.stations.size(); ++i) {
    const control::PlanePose& at = plan.stations[i].at;
    const Vec2 centre = at.p + axle_ahead * Vec2(std::cos(at.yaw), std::sin(at.yaw));
    if (reaches_heap(points, centre, at.yaw, most)) continue;
    faults.push_back({"from_m", place_text(job.heap->from),
                      "station " + std::to_string(i + 1) + " at " + place_text(at.p) +
                          " reaches no soil of the heap",
                      "the heap must lie along the fill, at most " + metres(most) + " aside"});
    break;
  }
}

}  // namespace

control::JobPlan plan_fill(const control::PitJob& job, const ArmReach& reach, const Pose& X_WB,
                           const control::SurfaceView& surface) {
  control::JobPlan out;
  const Fill fill(job, surface);
  out.volume = fill_volume(job, surface).left;
  const double axle_ahead = reach.arm().X_BS().translation().x();
  const Vec2 start = X_WB.translation().head<2>();
  const auto [low, high] = fill.hole.span(fill.ahead);
  // From the nearer end.
  const bool turned =
      std::abs(start.dot(fill.ahead) - high) < std::abs(start.dot(fill.ahead) - low);
  const Vec2 ahead = turned ? Vec2(-fill.ahead) : fill.ahead;
  const double near = turned ? -high : low, far = turned ? -low : high;
  const double yaw = std::atan2(ahead.y(), ahead.x());
  for (double done = near - kApron; done < far; done += kAdvance) {
    control::JobStation station;
    const double place = done - kFaceBegins - axle_ahead;
    station.at = {fill.middle + (place - fill.middle.dot(ahead)) * ahead, yaw};
    for (const PitColumn& one : fill.columns)
      if (const double at = one.p.dot(ahead); at >= done && at < done + kAdvance)
        station.volume += std::max(0.0, one.floor - one.top) * fill.hole.column_area();
    const double capacity = reach.arm().bucket().capacity;
    station.cuts = static_cast<std::int64_t>(std::ceil(station.volume / capacity));
    out.stations.push_back(station);
  }
  const double rise = X_WB.translation().z() - surface.height(start.x(), start.y());
  const double ring = fill.hole.ground() + rise + reach.arm().X_BS().translation().z();
  check_heap(fill, job, reach, ring, out, axle_ahead, out.faults);
  check_on_site(out.stations, surface, out.faults);
  // Then back over the same places: a strip leaves a ridge at its near end, of which only the
  // place behind it gets hold.
  for (std::size_t i = out.stations.size(); i-- > 1;)
    out.stations.push_back({out.stations[i - 1].at, 0, 0});
  return out;
}

std::vector<control::JobCut> fill_cuts(const control::PitJob& job, const ArmReach& reach,
                                       const Pose& X_WB, const control::SurfaceView& surface) {
  const Fill fill(job, surface);
  const double capacity = reach.arm().bucket().capacity;
  std::vector<control::JobCut> out;
  const std::optional<Hollow> hollow = largest_hollow(fill, job, reach.arm(), X_WB, surface);
  if (hollow) {
    out = heap_cuts(job, fill.heap, reach, X_WB, surface);
    const Pose X_WS = X_WB * reach.arm().X_BS();
    const Vec2 centre = X_WS.translation().head<2>();
    const double yaw = control::plane_pose(X_WB).yaw;
    const auto aside = [&](const control::JobCut& one) {
      const Vec2 line = one.far - centre;
      return std::abs(std::remainder(std::atan2(line.y(), line.x()) - yaw, 2 * kPi));
    };
    // What is beside the machine is out of its reach after the next drive.
    std::stable_sort(out.begin(), out.end(),
                     [&](const auto& a, const auto& b) { return aside(a) > aside(b); });
    for (control::JobCut& one : out) {
      one.dump_at = hollow->p;
      one.has_dump_at = true;
      one.fill = std::clamp(hollow->volume / capacity, kLeastScoop, 1.0);
    }
    if (!out.empty()) return out;
  }
  PitShape around = fill.hole;
  around.add_border(kBorder, kHeapSkin);
  out = cut_fan(job, around, reach, X_WB, surface);
  control::PitJob back = job;
  back.dump_from = job.heap->from;
  back.dump_to = job.heap->to;
  // Where the heap has no more scoops, this soil fills the hollow.
  const Vec2 place =
      hollow ? hollow->p
             : spoil_place(back, reach.arm(), X_WB * reach.arm().X_BS(), surface, fill.hole)
                   .value_or(job.heap->from);
  for (control::JobCut& one : out) {
    one.key += kLevelKeys;
    one.dump_at = place;
    one.has_dump_at = true;
  }
  return out;
}

control::JobVolume fill_volume(const control::PitJob& job, const control::SurfaceView& surface) {
  const PitShape hole(loose_shape(job), surface);
  control::JobVolume out;
  double squares = 0;
  const std::vector<PitColumn> columns = hole.columns();
  for (const PitColumn& one : columns) {
    out.left += std::max(0.0, one.floor - one.top) * hole.column_area();
    squares += (one.top - one.floor) * (one.top - one.floor);
  }
  out.design = out.left;
  if (!columns.empty()) out.rms = std::sqrt(squares / static_cast<double>(columns.size()));
  return out;
}

}  // namespace navvy::earthwork
