// SPDX-License-Identifier: Apache-2.0
// Figures against their gates, with a table of known deviations (known_deviations.md): a miss that
// is in the table shows but does not fail, so that a new one does. Nothing is forgiven in silence:
// a figure worse than the table says fails, and so does one that meets its gate while the table
// still calls it a miss, a gate that is not the table's, a row that nothing measures any more.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace navvy::tolerances {

/// low .. high; infinite where a side is open.
struct Band {
  double low = 0, high = 0;
  bool holds(double value) const { return value >= low && value <= high; }
};

/// One row of the table.
struct KnownDeviation {
  std::string test;    ///< as `./dev validate` names the case
  std::string figure;  ///< as printed
  Band now;            ///< where the figure lies at present, outside the gate
  Band tolerance;
  std::string reason;
};

/// Rows of the Markdown table in `text`: | test | figure | now | gate | why |.
/// @throws std::runtime_error naming the line that is no such row, whose band reaches into its
/// gate, or which stands twice.
std::vector<KnownDeviation> parse_known_deviations(const std::string& text);

enum class Verdict {
  kMet,              ///< within its gate, not in the table
  kOutOfTolerance,   ///< outside, not in the table: fails
  kKnownDeviation,   ///< outside, as the table says
  kBetterDeviation,  ///< outside still, but nearer to the gate than the table says: narrow the row
  kWorse,            ///< farther outside than the table says: fails
  kNewlyMet,         ///< within, while the table says it is missed: fails, take the row out
  kToleranceMoved    ///< the test's gate is not the table's: fails
};

/// `known` is null for a figure that is not in the table. Not a number is outside every gate and
/// worse than every row.
Verdict judge(const KnownDeviation* known, double measured, const Band& tolerance);

/// Prints the row figure, measured, expected, gate, result, source (tests/validation/table.py reads
/// it), and fails the running test as `judge` says. `expected` is left empty when it is not a
/// number.
void expect_between(const std::string& figure, double measured, double low, double high,
                    const std::string& source,
                    double expected = std::numeric_limits<double>::quiet_NaN());

}  // namespace navvy::tolerances
