// SPDX-License-Identifier: Apache-2.0
// Prints one row per measurement: quantity, measured, expected, tolerance, source; known deviations
// are reported without failing (tolerances/tolerances.h).
#pragma once

#include <cmath>
#include <limits>

#include "lab/report.h"
#include "tolerances/tolerances.h"

namespace navvy::validation {

using tolerances::expect_between;

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Judges every result of a rig that has a tolerance, and the ledger.
inline void expect_tolerances(const lab::Report& report) {
  for (const lab::Quantity& q : report.results)
    if (q.judged())
      expect_between(q.name + (q.unit.empty() ? "" : " [" + q.unit + "]"), q.measured,
                     std::isnan(q.low) ? -kNoLimit : q.low, std::isnan(q.high) ? kNoLimit : q.high,
                     q.source, q.expected);
  EXPECT_EQ(report.ledger_error, 0);
}

}  // namespace navvy::validation
