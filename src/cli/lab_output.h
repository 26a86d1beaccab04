// SPDX-License-Identifier: Apache-2.0
// Output of `navvy lab`: a table for the user, and JSON for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lab/rig.h"

namespace navvy::cli {

/// Returns an experiment as JSON: its inputs, results, expected values and time series. Keys
/// contain quantity and unit, as in scene files.
nlohmann::json to_json(const lab::Rig& rig, const lab::Setup& setup, const lab::Report& report);

/// Prints the results of an experiment to standard output, as a table with five significant digits.
/// Results outside their tolerance are marked. Lines with information about the run follow.
void print_table(const lab::Report& report);

}  // namespace navvy::cli
