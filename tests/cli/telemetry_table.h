// SPDX-License-Identifier: Apache-2.0
// Compares the two tables of a run's telemetry.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>

#include "text_of.h"

namespace navvy::test {

/// Expects telemetry.npy to hold the numbers of telemetry.csv of a run with `machines` machines.
inline void expect_same_table(const std::string& out, std::size_t machines) {
  const std::string bytes = text_of(std::filesystem::path(out) / "telemetry.npy");
  ASSERT_EQ(bytes.substr(1, 5), "NUMPY");
  std::istringstream lines(text_of(std::filesystem::path(out) / "telemetry.csv"));
  std::string line, cell;
  std::getline(lines, line);
  const auto columns = static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
  // The header states its length in two bytes. Time has 8 bytes, a phase 32, the others 4.
  std::size_t at = 10 + static_cast<unsigned char>(bytes[8]) +
                   256u * static_cast<std::size_t>(static_cast<unsigned char>(bytes[9]));
  while (std::getline(lines, line)) {
    ASSERT_LE(at + 8 + 4 * (columns - 1 - machines) + 32 * machines, bytes.size());
    std::istringstream cells(line);
    for (std::size_t i = 0; i < columns && std::getline(cells, cell, ','); ++i) {
      if (i + machines >= columns) {
        EXPECT_STREQ(bytes.substr(at, 32).c_str(), cell.c_str());
        at += 32;
        continue;
      }
      double time = 0;
      float value = 0;
      std::memcpy(i == 0 ? static_cast<void*>(&time) : &value, &bytes[at], i == 0 ? 8 : 4);
      const double number = std::stod(cell);
      EXPECT_NEAR(i == 0 ? time : value, number, 1e-6 * std::abs(number) + 1e-30) << line;
      at += i == 0 ? 8 : 4;
    }
  }
  EXPECT_EQ(at, bytes.size());
}

}  // namespace navvy::test
