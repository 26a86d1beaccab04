// SPDX-License-Identifier: Apache-2.0
// What `navvy lab` tells of an experiment: a table for a person, JSON for a program.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "lab/rig.h"

namespace navvy::cli {

/// Inputs first, so that a file says by itself what it is the result of. Keys name the quantity and
/// its unit, as scene files do.
nlohmann::json to_json(const lab::Rig& rig, const lab::Setup& setup, const lab::Report& report);

/// Results for a person: five digits, misses marked, how the run went in the lines below. A gate
/// that holds for other setups only is told with what it holds for.
void print_table(const lab::Report& report);

/// A line on a terminal with the share done; nothing when stderr is a file or pipe.
std::function<void(double)> progress_line(bool quiet);

}  // namespace navvy::cli
