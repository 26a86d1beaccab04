// SPDX-License-Identifier: Apache-2.0
// Cuts of a pit from one place of the machine. Private to earthwork.
#pragma once

#include <limits>
#include <vector>

#include "control/job_planner.h"
#include "earthwork/arm_reach.h"
#include "earthwork/pit_shape.h"
#include "earthwork/station_search.h"

namespace navvy::earthwork {

/// Limits of the strips of a fan.
struct FanLimits {
  /// Largest angle of a strip from straight ahead, to both sides [rad].
  double sector = kSector;
  /// True if a face is left ahead of the machine, on which it can stand.
  bool face = true;
  /// Least volume of a cut in layers above the last / heaped capacity: the rest waits for the next
  /// layer.
  double worth_above = 0.6;
  /// The same in the last layer.
  double worth_last = 0.3;
  /// True if the line straight ahead is square to a side of the pit however the machine stands, and
  /// cuts run on beyond high sides at the depth of the floor.
  bool square = false;
  /// Largest distance of a cut from the line straight ahead [m].
  double aside = std::numeric_limits<double>::infinity();
  /// Distance from the swing axis at which soil is dug, at least [m].
  double nearest = 0;
  /// Deviation (rms) from the design above which a strip is levelled at the end [m]; 0: that of the
  /// job.
  double tolerance = 0;
  /// Largest distance of the bucket's sides from the pit [m]: a trench is dug one bucket wide.
  double outside = 0.1;
  /// True if strips that are levelled go on beyond both sides of the pit at the depth of the floor.
  bool levels_beyond = false;
};

/// Returns the cuts that are worth a scoop from the pose X_WB of the base link: layer by layer from
/// the top, in each layer the strip with the most soil first; then, with a tolerance, the strips
/// that deviate by more from the design. Directions are a third of those closer at which strips
/// touch at the farthest soil, so that a strip fits what others have left between them. Places of
/// spoil are not filled in.
std::vector<control::JobCut> cut_fan(const control::PitJob& job, const PitShape& pit,
                                     const ArmReach& reach, const Pose& X_WB,
                                     const control::SurfaceView& surface,
                                     const FanLimits& limits = {});

/// Returns the number of strips side by side that `cut_fan` would begin with, over all layers.
std::size_t count_strips(const control::PitJob& job, const PitShape& pit, const ArmReach& reach,
                         const Pose& X_WB, const control::SurfaceView& surface,
                         const FanLimits& limits = {});

}  // namespace navvy::earthwork
