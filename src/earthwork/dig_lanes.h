// SPDX-License-Identifier: Apache-2.0
// Lanes along which a machine backs while it digs a pit. Private to earthwork.
#pragma once

#include <vector>

#include "control/job_planner.h"
#include "earthwork/arm_reach.h"
#include "earthwork/cut_fan.h"
#include "earthwork/pit_shape.h"
#include "earthwork/station_search.h"

namespace navvy::earthwork {

/// Returns true if a pit is wide enough to be dug square to its longest edge. `bucket_width` [m]
/// here and below.
bool is_wide(const PitShape& pit, double bucket_width);

/// Returns true if a pit is dug in straight lanes: its sides are too steep for strips that end
/// aslant at them, its floor is not levelled, and it is wide.
bool digs_straight(const control::PitJob& job, const PitShape& pit, double bucket_width);

/// Returns the lanes of a pit along a heading [rad], the one farthest from the spoil first. Lanes
/// are wide, or, if the pit is dug straight, narrow and in line with the sides.
std::vector<RetreatAxis> lanes(const control::PitJob& job, const PitShape& pit, double bucket_width,
                               double heading);

/// Returns the rules of the search for stations of a pit.
SearchRules search_rules(const control::PitJob& job, const PitShape& pit, double bucket_width);

/// Returns the limits of the cuts from a station of a pit.
FanLimits lane_limits(const control::PitJob& job, const PitShape& pit, double bucket_width);

/// Puts the stations of straight lanes along a heading [rad] in rows, the farthest first: so no
/// machine has to stand on ground that its neighbour lane has lost.
void sort_in_rows(double heading, std::vector<control::JobStation>& stations);

}  // namespace navvy::earthwork
