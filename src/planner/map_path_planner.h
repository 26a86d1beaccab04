// SPDX-License-Identifier: Apache-2.0
// The planner of paths that operators ask (control/path_planner.h), on the layer `traversability`.
#pragma once

#include "control/path_planner.h"

namespace navvy::planner {

/// Returns a maker of planners that use each machine's own footprint, tightest turn and
/// navvy:traversability. Unknown columns and everything beyond the edge of the site are not
/// drivable. Returns an empty function in a build without OMPL.
///
/// A look costs what changed since the last one; a plan costs a pass over the columns of the site
/// and its search.
control::MakePathPlanner path_planners();

}  // namespace navvy::planner
