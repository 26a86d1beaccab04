// SPDX-License-Identifier: Apache-2.0
// Table of bits: which columns are marked in which rows.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace navvy::soil {

/// Set of pairs (row, column). They arrive in any order and more than once, and are read sorted and
/// once. Cheaper than sorting them where columns are few.
///
/// Memory is one bit per pair. Marking costs one memory access, reading a row costs its columns /
/// 64 plus the marks. A row is a block, a column a triangle, so that candidate lists come out in
/// ascending order without a sort.
class Marks {
 public:
  Marks(std::size_t rows, std::size_t columns)
      : words_((columns + 63) / 64), bits_(rows * words_, 0) {}

  /// Marks a pair.
  void set(std::size_t row, std::size_t column) {
    bits_[row * words_ + column / 64] |= std::uint64_t{1} << (column % 64);
  }
  /// Returns true if any column of the row is marked.
  bool any(std::size_t row) const {
    for (std::size_t w = 0; w < words_; ++w)
      if (bits_[row * words_ + w] != 0) return true;
    return false;
  }
  /// Calls `use` with every marked column of the row, ascending.
  template <class Use>
  void each(std::size_t row, Use use) const {
    for (std::size_t w = 0; w < words_; ++w)
      for (std::uint64_t bits = bits_[row * words_ + w]; bits != 0; bits &= bits - 1)
        use(64 * w + static_cast<std::size_t>(std::countr_zero(bits)));
  }

 private:
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace navvy::soil
