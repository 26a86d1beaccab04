// SPDX-License-Identifier: Apache-2.0
// A small line chart as SVG text: what `navvy lab RIG --plot FILE.svg` writes.
//
// Our own writer, as a chart of a few lines needs no library: axes with round ticks, one colour and
// mark a line, a dashed line for what is expected, a grey band for a gate. Texts are escaped;
// nothing outside the file is referred to.
#pragma once

#include <string>
#include <vector>

namespace navvy::lab {

/// One line of a chart. Points that are no numbers are left out.
struct PlotLine {
  std::string name;          ///< in the legend
  std::vector<double> x, y;  ///< of one length, in the order in which they are joined
};

/// What is drawn. Units belong into the labels.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotLine> lines;
  std::vector<double> expected;                       ///< heights of dashed lines, drawn across
  std::vector<std::pair<double, double>> tolerances;  ///< bands from .first to .second
};

/// The chart, 760 x 480 units. The x axis is logarithmic when the values are positive and span a
/// factor of five; the y axis takes in zero when that costs little. A plot without a point is an
/// empty frame.
std::string svg_of(const Plot& plot);

/// Round numbers that cover low .. high, about `count` of them: steps of 1, 2 or 5 times a power of
/// ten.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace navvy::lab
