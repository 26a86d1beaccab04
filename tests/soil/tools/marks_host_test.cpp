// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/marks.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace navvy::soil {
namespace {

TEST(Marks, LeaveSortedAndOnceWhateverTheOrderTheyCameIn) {
  // More than three words per row, the last one not full.
  constexpr std::size_t kRows = 7, kColumns = 200;
  Marks marks(kRows, kColumns);
  std::vector<std::set<std::size_t>> expected(kRows);
  std::minstd_rand random(5);
  for (int i = 0; i < 400; ++i) {
    // The last row stays empty.
    const std::size_t row = random() % (kRows - 1), column = random() % kColumns;
    marks.set(row, column);
    expected[row].insert(column);
  }
  for (std::size_t edge : {std::size_t{0}, std::size_t{63}, std::size_t{64}, kColumns - 1}) {
    marks.set(2, edge);
    expected[2].insert(edge);
  }
  for (std::size_t row = 0; row < kRows; ++row) {
    std::vector<std::size_t> found;
    marks.each(row, [&](std::size_t column) { found.push_back(column); });
    EXPECT_EQ(found, std::vector<std::size_t>(expected[row].begin(), expected[row].end()));
    EXPECT_EQ(marks.any(row), !expected[row].empty());
  }
}

TEST(Marks, WithoutColumnsHaveNothing) {
  const Marks marks(3, 0);
  EXPECT_FALSE(marks.any(2));
}

}  // namespace
}  // namespace navvy::soil
