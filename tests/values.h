// SPDX-License-Identifier: Apache-2.0
// Figures that a test measured, printed as tests/validation/table.py reads them.
#pragma once

#include <cstdio>
#include <string>

namespace navvy {

/// One row of the table: what, measured, expected (as text: a number, a band, a law), source.
inline void print_value(const std::string& what, double measured, const std::string& expected,
                        const std::string& source) {
  std::printf("[ VALUE    ] %s: measured %.5g, expected %s (%s)\n", what.c_str(), measured,
              expected.c_str(), source.c_str());
}

}  // namespace navvy
