// SPDX-License-Identifier: Apache-2.0
// Interface through which an operator asks for stations and cuts of a whole job. A higher-level
// module implements it, and the application passes it in.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/pursuit.h"
#include "control/surface.h"
#include "core/archive.h"
#include "scene/design.h"
#include "scene/machine.h"

namespace navvy::control {

/// A heap or windrow from which soil is taken.
struct JobHeap {
  /// Ends (x, y) in W of its centre line [m].
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  /// Width of the strip that is dug [m].
  double width = 4;
};

/// A pit to dig, and the place of its spoil; or a hole to fill from a heap; or a heap from which
/// trucks are loaded.
struct PitJob {
  /// Shape of the pit, whose depth is above 0; or that of the ground after filling.
  scene::DesignArea area;
  /// Ends (x, y) in W of the windrow in which the spoil is dumped [m]; both the same: a heap.
  Vec2 dump_from = Vec2::Zero(), dump_to = Vec2::Zero();
  /// Ends of a second windrow, such as one on the other side [m]; nothing: there is none.
  std::optional<std::array<Vec2, 2>> second_windrow;
  /// Height of the bucket's tip above the ground when it opens [m].
  double dump_height = 1.5;
  /// Largest depth of a layer [m].
  double pass_depth = 0.5;
  /// Deviation (rms) from the design above which a strip of the floor is levelled [m]; 0: the floor
  /// is not levelled.
  double tolerance = 0;
  /// Heap from which the area is filled, or trucks are loaded; nothing: the area is dug.
  std::optional<JobHeap> heap;
  /// True if the soil goes into beds that stand at `dump_from`. With a heap the area is unused.
  bool into_beds = false;
  /// Height above the area up to which a hole is filled, for what a compaction will settle [m].
  double over = 0;
};

/// One cut of a job: a strip one bucket wide, radial to the swing axis, in one layer.
struct JobCut {
  /// Ends of the strip's centre line in W [m], the nearer and the farther one.
  Vec2 near = Vec2::Zero(), far = Vec2::Zero();
  /// Heights of its floor in W at equal distances from `near` to `far` [m], at least two.
  std::vector<double> floor = {0, 0};
  /// Height in W above which the bucket clears the sides of the pit while it swings [m].
  double rim = 0;
  /// Place (x, y) in W at which the soil is dumped [m].
  Vec2 dump_at = Vec2::Zero();
  /// True if there is such a place; false if the bucket can open over the spoil nowhere within
  /// reach, or if the soil goes into a bed.
  bool has_dump_at = false;
  /// Number of layer and direction; the same for the same cut on changed ground.
  std::int64_t key = 0;
  /// True for one pass along the whole strip, which levels it.
  bool levels = false;
  /// Share of the bucket's heaped capacity that one scoop shall bring; 0: as many scoops as the
  /// strip needs, each of a full bucket.
  double fill = 0;
  /// Share of a full bucket below which the rest of the strip stays.
  double worth = 0.3;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// One place from which a part of a job is dug.
struct JobStation {
  /// Pose of the middle of the rear axle.
  PlanePose at;
  /// Expected number of cuts and volume of soil [m3].
  std::int64_t cuts = 0;
  double volume = 0;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Fault that keeps a job from being done, as the check before a run reports it.
struct JobFault {
  /// Part of the job that is wrong, such as "dump_at".
  std::string part;
  /// Offending value, violated rule and suggestion.
  std::string value, rule, remedy;
  /// False for a warning.
  bool error = true;
};

/// Stations of a job in the order in which the machine works from them.
struct JobPlan {
  /// The stations.
  std::vector<JobStation> stations;
  /// Volume of the job [m3].
  double volume = 0;
  /// Faults that were found.
  std::vector<JobFault> faults;
};

/// Commanded volume of a job and the part of it that is left [m3], and the deviation (rms) of the
/// ground from the design [m]. For a fill both volumes are what the hole lacks at present.
struct JobVolume {
  double design = 0, left = 0, rms = 0;
};

/// Plans the job of one machine. All results depend only on the arguments, so that a run resumed
/// from a snapshot gets the same ones.
class JobPlanner {
 public:
  virtual ~JobPlanner() = default;
  /// Returns the stations of a job on ground that is `surface`, for a machine whose base link
  /// stands at X_WB at the start.
  virtual JobPlan plan(const PitJob& job, const Pose& X_WB, const SurfaceView& surface) const = 0;
  /// Returns the cuts that are worth a scoop on the present `surface`, from the place where the
  /// machine stands: layer by layer from the top, in each from one side to the other; then the
  /// strips that are to be levelled, if the job has a tolerance.
  virtual std::vector<JobCut> cuts(const PitJob& job, const Pose& X_WB,
                                   const SurfaceView& surface) const = 0;
  /// Returns the volumes of a job on the present `surface`.
  virtual JobVolume volume(const PitJob& job, const SurfaceView& surface) const = 0;
};

/// Function that makes a job planner for a machine.
using MakeJobPlanner = std::function<std::unique_ptr<JobPlanner>(const scene::Machine&)>;

}  // namespace navvy::control
