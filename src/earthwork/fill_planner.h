// SPDX-License-Identifier: Apache-2.0
// Jobs that fill a hole from a windrow: stations, scoops, and what is left. Private to earthwork.
#pragma once

#include <vector>

#include "control/job_planner.h"
#include "control/surface.h"
#include "earthwork/arm_reach.h"

namespace navvy::earthwork {

/// Returns the stations of a job with a heap. The machine works forwards along the longest edge of
/// the hole: from each station it fills the next few metres ahead of it, over which it drives then.
/// It begins at the end that is nearer to it.
control::JobPlan plan_fill(const control::PitJob& job, const ArmReach& reach, const Pose& X_WB,
                           const control::SurfaceView& surface);

/// Returns the scoops from the heap, those beside the machine first, each as large as the hollow
/// into which it is dumped; then, where no hollow is worth a scoop, the strips of the fill that lie
/// too high.
std::vector<control::JobCut> fill_cuts(const control::PitJob& job, const ArmReach& reach,
                                       const Pose& X_WB, const control::SurfaceView& surface);

/// Returns the volume that the present hole lacks, as commanded and as left, and the deviation of
/// the ground from the design.
control::JobVolume fill_volume(const control::PitJob& job, const control::SurfaceView& surface);

}  // namespace navvy::earthwork
