// SPDX-License-Identifier: Apache-2.0
// Sites on which a job is done in part, for runs that begin in the middle of one.
#pragma once

#include <cstdint>
#include <vector>

#include "control/job_planner.h"
#include "heightfield/layered_ground.h"
#include "heightfield/occupied_area.h"
#include "scene/machine.h"

namespace navvy::earthwork {

/// Result of `stage`.
struct PartDone {
  /// Part of the commanded volume that is dug.
  double share = 0;
  /// Volume that is dug, as it lay in the ground [m3].
  double volume = 0;
  /// Height of the spoil over the ground at the start [m].
  double heap = 0;
};

/// Digs a part of a job at once, as the machine whose base link stands at X_WB would have left the
/// site: the pit ahead of a face, which rises from the floor at the angle of the sides, at most
/// 1:1, and the spoil, at its loose density, at rest along that part of the windrow that the
/// stations so far reach. The mass of each soil is kept exactly.
/// @param share part of the commanded volume, 0.01 to 1
/// @param seed bends the face by up to 0.1 m; equal seeds give equal sites
/// @param bodies areas that bodies occupy
/// @throws InputError if the job has faults, if its soil has no friction, or if pit or spoil would
/// come under a body, or the spoil into the pit or to the border of the site; the ground is
/// unchanged then.
PartDone stage(const control::PitJob& job, const scene::Machine& machine, const Pose& X_WB,
               double share, std::uint64_t seed,
               const std::vector<heightfield::OccupiedArea>& bodies, heightfield::Ground& ground);

}  // namespace navvy::earthwork
