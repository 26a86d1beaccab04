// SPDX-License-Identifier: Apache-2.0
// Line chart as SVG text, written by `navvy lab RIG --plot FILE.svg`.
//
// A chart of a few lines needs no library: axes with round ticks, one colour and marker per line,
// dashed lines for expected values, a grey band for a tolerance. Texts are escaped; the file has no
// external references.
#pragma once

#include <string>
#include <vector>

namespace navvy::lab {

/// One line of a chart. Points that are not numbers are left out.
struct PlotLine {
  /// Name in the legend.
  std::string name;
  /// Coordinates, of equal length, in the order in which points are joined.
  std::vector<double> x, y;
};

/// Contents of a chart. Labels include units.
struct Plot {
  /// Texts of the chart.
  std::string title, x_label, y_label;
  /// Lines, in the order of the legend.
  std::vector<PlotLine> lines;
  /// Heights of dashed lines.
  std::vector<double> expected;
  /// Bands from .first to .second.
  std::vector<std::pair<double, double>> tolerances;
};

/// Returns the chart, 760 x 480 units. The x axis is logarithmic when the values are positive and
/// span a factor of five; the y axis includes zero when that costs little. A plot without a point
/// is an empty frame.
std::string svg_of(const Plot& plot);

/// Returns about `count` round numbers that cover low .. high: steps of 1, 2 or 5 times a power of
/// ten.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace navvy::lab
