// SPDX-License-Identifier: Apache-2.0
// Reads telemetry.csv of a run's folder, thinned evenly.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace navvy::report {

/// Returns the number of rows in the file without its header; 0 if there is no such file.
std::size_t count_rows(const std::string& file);

/// Sets the members `telemetry` and `phases` of a page's run: every row whose number is a multiple
/// of `every`, and the phases of all rows. A row that does not fit the header is left out, such as
/// the one that a kill cuts off.
void read_telemetry(const std::string& file, std::size_t every, nlohmann::json& run);

}  // namespace navvy::report
