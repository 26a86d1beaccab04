// SPDX-License-Identifier: Apache-2.0
#include "earthwork/pit_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "control/reach.h"
#include "core/error.h"
#include "earthwork/cut_fan.h"
#include "earthwork/dig_lanes.h"
#include "earthwork/fill_planner.h"
#include "earthwork/heap_plan.h"
#include "earthwork/pit_checks.h"
#include "earthwork/pit_shape.h"
#include "earthwork/spoil_place.h"
#include "earthwork/station_search.h"
#include "scene/polygon.h"

namespace navvy::earthwork {
namespace {

class PitPlanner final : public control::JobPlanner {
 public:
  explicit PitPlanner(const scene::Machine& machine) : arm_(machine), reach_(arm_) {}

  control::JobPlan plan(const control::PitJob& job, const Pose& X_WB,
                        const control::SurfaceView& surface) const override {
    control::JobPlan out;
    try {
      if (job.heap)
        return job.into_beds ? plan_loading(job, reach_, X_WB, surface)
                             : plan_fill(job, reach_, X_WB, surface);
      const PitShape pit(job.area, surface);
      out.volume = pit.volume().design;
      const double rise =
          X_WB.translation().z() - surface.height(X_WB.translation().x(), X_WB.translation().y());
      Choice found = choose(job, pit, X_WB, rise, surface);
      out.stations = std::move(found.stations);
      count_cuts(job, pit, rise, surface, out);
      out.faults = check_pit(job, pit, surface);
      out.faults.insert(out.faults.end(), found.faults.begin(), found.faults.end());
    } catch (const InputError& error) {
      for (const Fault& fault : error.faults())
        out.faults.push_back({"polygon_m", fault.value, fault.rule, fault.remedy});
    }
    return out;
  }

  std::vector<control::JobCut> cuts(const control::PitJob& job, const Pose& X_WB,
                                    const control::SurfaceView& surface) const override {
    if (job.heap && job.into_beds)
      return heap_cuts(job, heap_shape(*job.heap, surface), reach_, X_WB, surface);
    if (job.heap) return fill_cuts(job, reach_, X_WB, surface);
    const PitShape pit(job.area, surface);
    std::vector<control::JobCut> out =
        cut_fan(job, pit, reach_, X_WB, surface, lane_limits(job, pit, arm_.bucket().width));
    if (out.empty() || job.into_beds) return out;
    const std::optional<Vec2> place = spoil_place(job, arm_, X_WB * arm_.X_BS(), surface, pit);
    for (control::JobCut& one : out) {
      one.has_dump_at = place.has_value();
      if (place) one.dump_at = *place;
    }
    return out;
  }

  control::JobVolume volume(const control::PitJob& job,
                            const control::SurfaceView& surface) const override {
    if (!job.heap) return PitShape(job.area, surface).volume();
    return job.into_beds ? loading_volume(job, surface) : fill_volume(job, surface);
  }

 private:
  /// Stations that were chosen, and their faults.
  struct Choice {
    std::vector<control::JobStation> stations;
    std::vector<control::JobFault> faults;
  };

  /// Returns the stations along the best of the axes parallel and square to the longest edge: those
  /// that leave the least soil, then those with the fewest faults, such as spoil out of reach, then
  /// the fewest stations, then those whose first one is nearest to the machine.
  Choice choose(const control::PitJob& job, const PitShape& pit, const Pose& X_WB, double rise,
                const control::SurfaceView& surface) const {
    const Vec2 longest = scene::longest_edge(job.area.polygon);
    const double along = std::atan2(longest.y(), longest.x());
    const Digger digger{reach_, pit.ground() + rise + arm_.X_BS().translation().z(),
                        arm_.X_BS().translation().x()};
    Choice best;
    std::array<double, 4> least{};
    const double width = arm_.bucket().width;
    for (int i = 0; i < 4; i += is_wide(pit, width) ? 1 : 2) {
      const double heading = along + i * kPi / 2;
      Stations one = find_stations(job, pit, digger, lanes(job, pit, width, heading),
                                   search_rules(job, pit, width));
      if (digs_straight(job, pit, width)) sort_in_rows(heading, one.stations);
      std::vector<control::JobFault> faults;
      check_stations(job, one, {arm_, rise}, surface, faults);
      const Vec2 start = X_WB.translation().head<2>();
      const double away = one.stations.empty() ? 1e9 : (one.stations.front().at.p - start).norm();
      // A tenth of a bucket is no reason for another axis.
      const std::array<double, 4> cost = {std::round(one.lost / 0.1),
                                          static_cast<double>(faults.size()),
                                          static_cast<double>(one.stations.size()), away};
      if (i > 0 && !(cost < least)) continue;
      best = {std::move(one.stations), std::move(faults)};
      least = cost;
    }
    return best;
  }

  /// Counts the cuts of each station on untouched ground. A strip that a station before it digs in
  /// part counts at both.
  void count_cuts(const control::PitJob& job, const PitShape& pit, double rise,
                  const control::SurfaceView& surface, control::JobPlan& plan) const {
    const FanLimits limits = lane_limits(job, pit, arm_.bucket().width);
    for (control::JobStation& one : plan.stations)
      one.cuts = static_cast<std::int64_t>(
          count_strips(job, pit, reach_, station_pose(one.at, rise, surface), surface, limits));
  }

  const control::ArmKinematics arm_;
  const ArmReach reach_;
};

}  // namespace

control::MakeJobPlanner job_planners() {
  return [](const scene::Machine& machine) -> std::unique_ptr<control::JobPlanner> {
    return std::make_unique<PitPlanner>(machine);
  };
}

}  // namespace navvy::earthwork
