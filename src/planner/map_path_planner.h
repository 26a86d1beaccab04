// SPDX-License-Identifier: Apache-2.0
// Path planner for operators (control/path_planner.h), based on the map layer `traversability`.
#pragma once

#include "control/path_planner.h"

namespace navvy::planner {

/// Returns a function that makes a path planner for a machine. The planner uses the machine's
/// footprint, minimum turning radius and limits (navvy:traversability). Unknown columns and
/// everything outside the site are not drivable. Returns an empty function in a build without OMPL.
///
/// PathPlanner::look takes time in proportion to the changes since its last call. PathPlanner::plan
/// takes a pass over all columns of the site, plus the search.
control::MakePathPlanner path_planners();

}  // namespace navvy::planner
