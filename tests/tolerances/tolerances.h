// SPDX-License-Identifier: Apache-2.0
// Compares results with their tolerances, with a table of known deviations (known_deviations.md): a
// deviation in the table is reported but does not fail, so that a new one does. A result also fails
// if it is worse than its row, or meets its tolerance while the table still lists it, if the test's
// tolerance is not that of the table, or if a row is no longer measured.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace navvy::tolerances {

/// A range low .. high; infinite on an open side.
struct Band {
  double low = 0, high = 0;
  bool holds(double value) const { return value >= low && value <= high; }
};

/// One row of the table.
struct KnownDeviation {
  /// Name of the case as in `./dev validate`.
  std::string test;
  /// Quantity as printed.
  std::string quantity;
  /// Present range of the result, outside the tolerance.
  Band now;
  Band tolerance;
  std::string reason;
};

/// Returns the rows of the Markdown table in `text`: | test | quantity | now | tolerance | cause |.
/// @throws std::runtime_error naming the line that is not such a row, whose range overlaps its
/// tolerance, or which occurs twice.
std::vector<KnownDeviation> parse_known_deviations(const std::string& text);

enum class Verdict {
  /// Within its tolerance, not in the table.
  kMet,
  /// Outside, not in the table: fails.
  kOutOfTolerance,
  /// Outside, as in the table.
  kKnownDeviation,
  /// Outside, but nearer to the tolerance than in the table: narrow the row.
  kBetterDeviation,
  /// Farther outside than in the table: fails.
  kWorse,
  /// Within, while the table lists a deviation: fails, remove the row.
  kNewlyMet,
  /// The test's tolerance differs from the table: fails.
  kToleranceMoved
};

/// Judges a result. `known` is null for a quantity that is not in the table. NaN is outside every
/// tolerance and worse than every row.
Verdict judge(const KnownDeviation* known, double measured, const Band& tolerance);

/// Prints the row quantity, measured, expected, tolerance, result, source (read by
/// tests/validation/table.py), and fails the running test according to `judge`. `expected` is left
/// empty if it is NaN.
void expect_between(const std::string& quantity, double measured, double low, double high,
                    const std::string& source,
                    double expected = std::numeric_limits<double>::quiet_NaN());

}  // namespace navvy::tolerances
