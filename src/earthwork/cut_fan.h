// SPDX-License-Identifier: Apache-2.0
// Cuts of a pit from one place of the machine. Private to earthwork.
#pragma once

#include <vector>

#include "control/job_planner.h"
#include "earthwork/arm_reach.h"
#include "earthwork/pit_shape.h"
#include "earthwork/station_search.h"

namespace navvy::earthwork {

/// Returns the cuts that are worth a scoop from the pose X_WB of the base link: layer by layer from
/// the top, in each layer one strip per direction; then, for a job with a tolerance, the strips
/// that deviate by more from the design. The directions are so close that strips touch at the
/// farthest soil and overlap nearer to the machine. Places of spoil are not filled in. `sector` is
/// the largest angle of a strip from straight ahead, to both sides [rad].
std::vector<control::JobCut> cut_fan(const control::PitJob& job, const PitShape& pit,
                                     const ArmReach& reach, const Pose& X_WB,
                                     const control::SurfaceView& surface, double sector = kSector);

}  // namespace navvy::earthwork
