// SPDX-License-Identifier: Apache-2.0
// Line charts as SVG text, which `navvy lab RIG --plot FILE.svg` writes.
//
// A chart has axes with round tick values, one colour and marker shape per line, dashed lines
// for expected values and grey bands for tolerances. Texts are escaped, and the SVG refers to no
// external files.
#pragma once

#include <string>
#include <vector>

namespace navvy::lab {

/// One line of a chart. Points with a coordinate that is not finite are left out.
struct PlotLine {
  /// Name of the line, as the legend shows it.
  std::string name;
  /// Coordinates of the line's points, in the units of the axes, in the order in which they are
  /// joined. Both lists have the same length.
  std::vector<double> x, y;
};

/// Contents of a line chart.
struct Plot {
  /// Title of the chart and labels of its x and y axes, with units.
  std::string title, x_label, y_label;
  /// Lines of the chart, in the order of the legend.
  std::vector<PlotLine> lines;
  /// Expected values, drawn as dashed horizontal lines at these y values.
  std::vector<double> expected;
  /// Tolerances, drawn as grey horizontal bands from y = .first to y = .second.
  std::vector<std::pair<double, double>> tolerances;
};

/// Returns the chart as the text of an SVG file of 760 x 480 pixels. The x axis is logarithmic if
/// all x values are positive and the largest is more than five times the smallest. The y axis
/// starts at zero unless all values are far above zero. A plot without points gives an empty frame.
std::string svg_of(const Plot& plot);

/// Returns tick values for an axis from `low` to `high`: all multiples of a step within that range.
/// The step is 1, 2 or 5 times a power of ten, chosen so that there are about `count` ticks.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace navvy::lab
