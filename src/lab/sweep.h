// SPDX-License-Identifier: Apache-2.0
// One rig at several speeds, steps, cells, cohesions: every combination, told in one table and one
// picture.
//
// A force that depends on the step or the cell has no value, and one run does not show it. A list
// of values on the command line makes an axis; all axes together make the runs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/rig.h"
#include "lab/svg_plot.h"

namespace navvy::lab {

/// One quantity that is varied.
struct SweepAxis {
  std::string name, unit;  ///< as on the command line; "" for a pure number
  std::vector<double> values;
};

/// One run and where it stands on every axis, in the axes' order.
struct SweepRun {
  std::vector<double> at;
  Report report;
};

struct Sweep {
  std::vector<SweepAxis> axes;
  std::vector<SweepRun> runs;
};

/// Values of a list, "0.05,0.15,0.3"; a single one is a list of one. @throws InputError for an
/// empty part.
std::vector<std::string> listed(const std::string& option, const std::string& written);

/// Every combination of the axes' values, the last axis fastest. Without axes the one empty
/// combination.
std::vector<std::vector<double>> combinations(const std::vector<SweepAxis>& axes);

/// What the rig's table and picture show: its headline results that the report has, else its first.
std::vector<std::string> shown_results(const Rig& rig, const Report& report);

/// Rows of cells, the heading first: the axes, the shown results, whether a gate was missed.
std::vector<std::vector<std::string>> table_of(const Rig& rig, const Sweep& sweep);

/// The table as text, columns right-aligned and as wide as they need.
std::string text_of(const std::vector<std::vector<std::string>>& table);

/// The first shown result over the first axis of more than one value, a line for each combination
/// of the others. Expectations and gates are drawn where all runs have the same.
Plot plot_of(const Rig& rig, const Sweep& sweep);

}  // namespace navvy::lab
