// SPDX-License-Identifier: Apache-2.0
// Output of the ratings of machines: tables for people, CSV and JSON for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vehicle/rating/lift_capacity.h"
#include "vehicle/rating/tool_force.h"

namespace navvy::cli {

/// A tool force of a machine.
struct ToolForceRow {
  std::string machine;
  vehicle::ToolForceRating rating;
};
/// Prints the rated and the standing force of each row, and with `curve` the curves.
void print_tool_forces(const std::vector<ToolForceRow>& rows, bool curve);
/// Returns all forces as a CSV table with one line per position, in SI units and degrees.
std::string tool_force_csv(const std::vector<ToolForceRow>& rows);
/// Returns all forces as JSON, in SI units and degrees.
nlohmann::json tool_force_json(const std::vector<ToolForceRow>& rows);

/// Lift chart of a machine.
struct LiftTable {
  /// Capacities at one height.
  struct Line {
    /// Capacities by heading, then by reach; empty where the arm does not get.
    std::vector<std::vector<std::optional<vehicle::LiftCapacity>>> at_reach;
    /// Capacities by heading, at the largest reach.
    std::vector<std::optional<vehicle::LiftCapacity>> at_most;
  };
  std::string machine;
  bool with_bucket = false;
  std::vector<double> reaches, heights;  ///< [m]
  std::vector<double> headings;          ///< [rad]
  std::vector<Line> lines;               ///< one per height
};
/// Fills the lines of a table from a chart.
void fill(LiftTable& table, vehicle::LiftChart& chart);
/// Prints the tables.
void print_lift_tables(const std::vector<LiftTable>& tables);
/// Returns all capacities as a CSV table with one line per position, in SI units and degrees.
std::string lift_csv(const std::vector<LiftTable>& tables);
/// Returns all capacities as JSON, in SI units and degrees.
nlohmann::json lift_json(const std::vector<LiftTable>& tables);

}  // namespace navvy::cli
