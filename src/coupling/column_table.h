// SPDX-License-Identifier: Apache-2.0
// Sparse table of values by column of a site.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/archive.h"

namespace navvy::coupling {

/// Stores a value for each column that `at` was called for. Iterates and saves by iy * nx + ix, as
/// a map of that key would.
///
/// A row is divided into strips of 32 columns, and a strip stores the values of its columns side by
/// side. This takes 3 bytes per column beside the value where a rut follows the rows, and 24 where
/// a rut of four columns crosses them; a node of a map takes 56. A look-up searches the strips,
/// which are fewer than the columns.
template <class T>
class ColumnTable {
 public:
  /// Makes an empty table for a site of nx x ny columns.
  ColumnTable(int nx, int ny) : nx_(nx), ny_(ny) {}

  /// Returns the value of a column of the site and creates it if it is new. The reference is valid
  /// until the next call.
  T& at(int ix, int iy) {
    Strip& strip = strips_[key_of(ix, iy)];
    const std::uint32_t bit = bit_of(ix);
    const auto place = static_cast<std::ptrdiff_t>(strip.before(bit));
    if ((strip.mask & bit) == 0) {
      // Grow by a few entries: doubling would leave a third unused.
      if (strip.values.size() == strip.values.capacity())
        strip.values.reserve(strip.values.size() + kMoreClearance);
      strip.values.emplace(strip.values.begin() + place);
      strip.mask |= bit;
      ++size_;
    }
    return strip.values[static_cast<std::size_t>(place)];
  }

  /// Returns the value of a column, null if it has none.
  const T* find(int ix, int iy) const {
    const auto found = strips_.find(key_of(ix, iy));
    const std::uint32_t bit = bit_of(ix);
    if (found == strips_.end() || (found->second.mask & bit) == 0) return nullptr;
    return &found->second.values[found->second.before(bit)];
  }

  /// Returns the number of columns with a value.
  std::size_t size() const { return size_; }

  /// Visits all values. @throws InputError for a column outside the site.
  void visit(Archive& a) {
    const std::uint64_t count = a.size("columns", size_);
    if (a.loading()) {
      load(a, count);
      return;
    }
    std::uint64_t number = 0;
    for (auto& entry : strips_) {
      Strip& strip = entry.second;
      const std::int64_t first = entry.first / strips_x() * nx_ + entry.first % strips_x() * kStrip;
      std::size_t next = 0;
      for (std::uint32_t rest = strip.mask; rest != 0; rest &= rest - 1)
        a.item(number++, [&] {
          std::int64_t column = first + std::countr_zero(rest);
          a("column", column);
          a("value", strip.values[next++]);
        });
    }
  }

 private:
  static constexpr int kStrip = 32;  // columns, one bit each
  static constexpr std::size_t kMoreClearance = 4;

  /// Values of up to 32 neighbouring columns of a row.
  struct Strip {
    std::uint32_t mask = 0;  // columns that have a value
    std::vector<T> values;   // their values, in the same order

    /// Returns the number of columns with a value before the one of `bit`.
    std::size_t before(std::uint32_t bit) const {
      return static_cast<std::size_t>(std::popcount(mask & (bit - 1)));
    }
  };

  /// Returns the number of strips per row.
  std::int64_t strips_x() const { return (static_cast<std::int64_t>(nx_) + kStrip - 1) / kStrip; }
  /// Returns the key of the strip that contains a column.
  std::int64_t key_of(int ix, int iy) const { return iy * strips_x() + ix / kStrip; }
  /// Returns the bit of a column in its strip.
  static std::uint32_t bit_of(int ix) { return std::uint32_t{1} << (ix % kStrip); }

  /// Loads `count` columns, which must be in ascending order.
  void load(Archive& a, std::uint64_t count) {
    strips_.clear();
    size_ = 0;
    std::int64_t before = -1;
    const std::int64_t columns = static_cast<std::int64_t>(nx_) * ny_;
    for (std::uint64_t n = 0; n < count; ++n)
      a.item(n, [&] {
        std::int64_t column = 0;
        a.ranged("column", column, before + 1, columns - 1);
        before = column;
        a("value", at(static_cast<int>(column % nx_), static_cast<int>(column / nx_)));
      });
  }

  int nx_, ny_;
  std::size_t size_ = 0;
  // Strips by row, then along the row: in the order of columns.
  std::map<std::int64_t, Strip> strips_;
};

}  // namespace navvy::coupling
