// SPDX-License-Identifier: Apache-2.0
// The paths that the operators of a run have planned, as a table and as lines to draw.
#pragma once

#include <string>
#include <vector>

#include "control/path.h"
#include "map/map_line.h"

namespace navvy::record {

/// Returns the first line of the path table, which holds the column names, without a line end.
std::string path_header();
/// Returns the rows of the path table for the planned paths of the machine called `machine`, each
/// with a line end. Each path has a row every 0.1 m and one at its end. The column `plan` counts
/// the paths of each program step from 1.
std::string path_rows(const std::string& machine, const std::vector<control::PlannedPath>& paths);

/// Reads a path table from `file`. Returns one line per path in the order of the table, each with
/// the value of the column `plan`.
/// @throws FileError if the file does not exist; InputError with file and line number for a row in
/// another form.
std::vector<map::MapLine> read_paths(const std::string& file);

}  // namespace navvy::record
