// SPDX-License-Identifier: Apache-2.0
// Whom operators ask for a way (control/path_planner.h): paths on the layer `traversability`.
#pragma once

#include "control/path_planner.h"

namespace navvy::planner {

/// Planners for machines by their own footprint, tightest turn and navvy:traversability. Unknown
/// columns and everything beyond the site's edge are not traversable. Empty in a build without
/// OMPL.
///
/// A look costs what changed since the last one, a plan a pass over the site's columns and its
/// search.
control::MakePathPlanner path_planners();

}  // namespace navvy::planner
