// SPDX-License-Identifier: Apache-2.0
// Paths that a run's operators planned, as a table and as lines to draw.
#pragma once

#include <string>
#include <vector>

#include "control/path.h"

namespace navvy::planner {

/// First line of the table, without its end.
std::string path_header();
/// Rows of one machine's paths, each with its line end: a place every 0.1 m and the end of each
/// path. Plans are counted from 1 in each step.
std::string path_rows(const std::string& machine, const std::vector<control::PlannedPath>& paths);

/// A path as a picture shows it.
struct PathLine {
  int plan = 1;              ///< of its step, the first is 1
  std::vector<Vec2> places;  ///< [m] in W
};
/// The paths of such a table, in its order. @throws FileError when there is none, InputError with
/// file and line for a row that is none.
std::vector<PathLine> read_paths(const std::string& file);

}  // namespace navvy::planner
