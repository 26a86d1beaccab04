// SPDX-License-Identifier: Apache-2.0
// A rig run at all combinations of several speeds, steps, cells or cohesions, in one table and one
// plot.
//
// A force that depends on the step or the cell is not a result, and one run does not show the
// dependence. A list of values on the command line makes an axis; all axes together make the runs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/rig.h"
#include "lab/svg_plot.h"

namespace navvy::lab {

/// One varied quantity.
struct SweepAxis {
  /// Texts as on the command line; "" for a pure number.
  std::string name, unit;
  /// Values, in the order of the command line.
  std::vector<double> values;
};

/// One run and its values, in the order of the axes.
struct SweepRun {
  /// One value per axis.
  std::vector<double> at;
  /// Results of the run.
  Report report;
};

/// All axes and runs of a sweep.
struct Sweep {
  std::vector<SweepAxis> axes;
  std::vector<SweepRun> runs;
};

/// Splits a list, "0.05,0.15,0.3"; a single value is a list of one.
/// @throws InputError for an empty part.
std::vector<std::string> listed(const std::string& option, const std::string& written);

/// Returns every combination of the axes' values, the last axis fastest. Without axes, the one
/// empty combination.
std::vector<std::vector<double>> combinations(const std::vector<SweepAxis>& axes);

/// Returns the results that table and plot show: those of the rig's headline that the report has,
/// else its first.
std::vector<std::string> shown_results(const Rig& rig, const Report& report);

/// Returns rows of cells, the heading first: the axes, the shown results, and missed tolerances.
std::vector<std::vector<std::string>> table_of(const Rig& rig, const Sweep& sweep);

/// Returns the table as text with right-aligned columns.
std::string text_of(const std::vector<std::vector<std::string>>& table);

/// Returns a plot of the first shown result over the first axis of more than one value, with a line
/// for each combination of the others. Expectations and tolerances are drawn if all runs share
/// them.
Plot plot_of(const Rig& rig, const Sweep& sweep);

}  // namespace navvy::lab
