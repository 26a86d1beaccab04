// SPDX-License-Identifier: Apache-2.0
// Reads telemetry.csv of a run's folder, thinned evenly.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace navvy::report {

/// The parts of a page that telemetry.csv gives.
struct TelemetryData {
  nlohmann::json telemetry;  ///< names, units, number of rows and values; null without rows
  nlohmann::json phases = nlohmann::json::array();  ///< spans of the phases of each machine
  std::size_t rows = 0;                             ///< rows in the file
};

/// Returns the number of rows in the file without its header; 0 if there is no such file.
std::size_t count_rows(const std::string& file);

/// Returns every row whose number is a multiple of `every`, and the phases of all rows. A row that
/// does not fit the header is left out, such as the one that a kill cuts off.
TelemetryData read_telemetry(const std::string& file, std::size_t every);

}  // namespace navvy::report
