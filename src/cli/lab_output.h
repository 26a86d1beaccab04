// SPDX-License-Identifier: Apache-2.0
// Output of `navvy lab`: a table for people, JSON for programs.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "lab/rig.h"

namespace navvy::cli {

/// Returns an experiment as JSON: inputs, results, expectations and series. Keys contain quantity
/// and unit, as in scene files.
nlohmann::json to_json(const lab::Rig& rig, const lab::Setup& setup, const lab::Report& report);

/// Prints the results as a table with five digits, marks those outside their acceptance range, and
/// adds lines about the run.
void print_table(const lab::Report& report);

/// Returns a function that shows progress on a terminal; empty when stderr is a file or pipe.
std::function<void(double)> progress_line(bool quiet);

}  // namespace navvy::cli
