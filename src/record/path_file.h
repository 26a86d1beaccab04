// SPDX-License-Identifier: Apache-2.0
// Paths that the operators of a run planned, as a table and as lines to draw.
#pragma once

#include <string>
#include <vector>

#include "control/path.h"
#include "map/map_line.h"

namespace navvy::record {

/// Returns the first line of the table, without its end.
std::string path_header();
/// Returns the rows of one machine's paths, each with its line end: a place every 0.1 m and the end
/// of each path. Plans are counted from 1 in each step.
std::string path_rows(const std::string& machine, const std::vector<control::PlannedPath>& paths);

/// Reads such a table: a line per path, with the number of the plan within its step, in the order
/// of the table. @throws FileError when the file does not exist, InputError with file and line for
/// a row that is not one of such a table.
std::vector<map::MapLine> read_paths(const std::string& file);

}  // namespace navvy::record
