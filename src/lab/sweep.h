// SPDX-License-Identifier: Apache-2.0
// Sweeps: a rig is run at every combination of several speeds, steps, cell sizes or cohesions, and
// the results are shown in one table and one plot.
//
// A sweep shows whether a result depends on the time step or the cell size, which a single run
// cannot show. A list of values on the command line makes one axis of the sweep.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/rig.h"
#include "lab/svg_plot.h"

namespace navvy::lab {

/// One quantity that a sweep varies.
struct SweepAxis {
  /// Name of the quantity as on the command line, and its unit as text ("" for a dimensionless
  /// number).
  std::string name, unit;
  /// Values of the quantity in `unit`, in the order of the command line.
  std::vector<double> values;
};

/// One completed run of a sweep.
struct SweepRun {
  /// Value of the run on each axis, in the order of Sweep::axes.
  std::vector<double> at;
  /// Results that the rig reported for the run.
  Report report;
};

/// The axes of a sweep and its completed runs.
struct Sweep {
  /// Varied quantities; empty for a single run.
  std::vector<SweepAxis> axes;
  /// Completed runs, in the order in which they were made.
  std::vector<SweepRun> runs;
};

/// Returns the parts of a text that are separated by commas: "0.05,0.15" gives two parts, a single
/// value gives one. `option` is the option name for the error message.
/// @throws InputError if a part is empty.
std::vector<std::string> listed(const std::string& option, const std::string& written);

/// Returns every combination of the axes' values. Each combination has one value per axis, and the
/// last axis varies fastest. Without axes, the result is one empty combination.
std::vector<std::vector<double>> combinations(const std::vector<SweepAxis>& axes);

/// Returns the names of the results that table and plot show: those of Rig::headline that `report`
/// contains. If there is none, the result is the name of the report's first result.
std::vector<std::string> shown_results(const Rig& rig, const Report& report);

/// Returns a table of the sweep as rows of cell texts. The first row holds the headings; each
/// further row holds one run: its axis values, its shown results, its steps, its wall time [s], and
/// "outside" if a result is outside its tolerance.
std::vector<std::vector<std::string>> table_of(const Rig& rig, const Sweep& sweep);

/// Returns the table as text with right-aligned columns. `table` holds rows of cell texts.
std::string text_of(const std::vector<std::vector<std::string>>& table);

/// Returns a plot of the first shown result as a function of the first axis that has more than one
/// value. Each combination of the other axes' values makes one line. The expected value and the
/// tolerance are drawn only if they are the same in all runs.
Plot plot_of(const Rig& rig, const Sweep& sweep);

}  // namespace navvy::lab
