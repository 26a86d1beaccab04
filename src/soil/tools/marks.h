// SPDX-License-Identifier: Apache-2.0
// Bit table that records which columns are marked in which rows.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace navvy::soil {

/// Set of pairs (row, column). Pairs may be added in any order and repeatedly; each is read once,
/// in ascending order. This is faster than sorting the pairs if there are few columns.
///
/// Memory is one bit per pair. Marking a pair costs one memory access; reading a row costs columns
/// / 64 steps plus one per mark. For near lists a row is a block and a column is a triangle, so the
/// triangles of each block come out in ascending order.
class Marks {
 public:
  /// Creates a table without marks.
  Marks(std::size_t rows, std::size_t columns)
      : words_((columns + 63) / 64), bits_(rows * words_, 0) {}

  /// Marks the pair (row, column).
  void set(std::size_t row, std::size_t column) {
    bits_[row * words_ + column / 64] |= std::uint64_t{1} << (column % 64);
  }
  /// Returns true if any column of the row is marked.
  bool any(std::size_t row) const {
    for (std::size_t w = 0; w < words_; ++w)
      if (bits_[row * words_ + w] != 0) return true;
    return false;
  }
  /// Calls `use(column)` for every marked column of the row, in ascending order.
  template <class Use>
  void each(std::size_t row, Use use) const {
    for (std::size_t w = 0; w < words_; ++w)
      for (std::uint64_t bits = bits_[row * words_ + w]; bits != 0; bits &= bits - 1)
        use(64 * w + static_cast<std::size_t>(std::countr_zero(bits)));
  }

 private:
  /// Number of 64-bit words per row.
  std::size_t words_;
  /// Bits of all rows; bit c % 64 of word c / 64 is column c.
  std::vector<std::uint64_t> bits_;
};

}  // namespace navvy::soil
