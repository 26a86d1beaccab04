// SPDX-License-Identifier: Apache-2.0
// Prints values measured by a test in the form that tests/validation/table.py reads.
#pragma once

#include <cstdio>
#include <string>

namespace navvy {

/// Prints one row of the table: quantity, measured, expected (as text: a number, a range, a law),
/// source.
inline void print_value(const std::string& what, double measured, const std::string& expected,
                        const std::string& source) {
  std::printf("[ VALUE    ] %s: measured %.5g, expected %s (%s)\n", what.c_str(), measured,
              expected.c_str(), source.c_str());
}

}  // namespace navvy
