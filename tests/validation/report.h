// SPDX-License-Identifier: Apache-2.0
// One printed row a measurement: figure, measured, expected, gate, source; known deviations show
// without failing (tolerances/tolerances.h).
#pragma once

#include <cmath>
#include <limits>

#include "lab/report.h"
#include "tolerances/tolerances.h"

namespace navvy::validation {

using tolerances::expect_between;

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Every result of a rig that its gate judges, and the ledger.
inline void expect_tolerances(const lab::Report& report) {
  for (const lab::Quantity& q : report.results)
    if (q.judged())
      expect_between(q.name + (q.unit.empty() ? "" : " [" + q.unit + "]"), q.measured,
                     std::isnan(q.low) ? -kNoLimit : q.low, std::isnan(q.high) ? kNoLimit : q.high,
                     q.source, q.expected);
  EXPECT_EQ(report.ledger_error, 0);
}

}  // namespace navvy::validation
