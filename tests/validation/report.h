// SPDX-License-Identifier: Apache-2.0
// One printed row a measurement: case, measured, expected, tolerance, source; and the check that belongs to it.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>

namespace navvy::validation {

/// Prints the row only: what tests/README.md lists as a miss, so that the case gates the rest.
inline void note_between(const char* name, double measured, double low, double high, const char* source) {
  std::printf("| %-44s | %12.5g | %10.5g .. %-10.5g | %s | %s |\n", name, measured, low, high,
              measured >= low && measured <= high ? "ok  " : "MISS", source);
}

/// Prints the row and expects low <= measured <= high.
inline void expect_between(const char* name, double measured, double low, double high, const char* source) {
  note_between(name, measured, low, high, source);
  EXPECT_GE(measured, low) << name;
  EXPECT_LE(measured, high) << name;
}

}  // namespace navvy::validation
