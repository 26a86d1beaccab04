// SPDX-License-Identifier: Apache-2.0
// A sparse table with one value per ground column.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/archive.h"

namespace navvy::coupling {

/// Stores one value of type T for each column for which `at` has been called. Columns are visited
/// row by row, in ascending order of iy * nx + ix.
///
/// Each row of columns is divided into strips of 32 columns, and the values of a strip are stored
/// contiguously. In addition to the values, this takes about 3 bytes per column if a rut runs along
/// the rows, and 24 bytes if a rut four columns wide runs across them; a std::map with one node per
/// column would take 56 bytes. Access requires a search among the strips.
template <class T>
class ColumnTable {
 public:
  /// Makes an empty table for a site of nx x ny columns.
  ColumnTable(int nx, int ny) : nx_(nx), ny_(ny) {}

  /// Returns the value of the column (ix, iy), which must be on the site. A new column gets a
  /// default value. The reference is valid until the next call of `at`.
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

  /// Returns a pointer to the value of the column (ix, iy); null if the column has no value.
  const T* find(int ix, int iy) const {
    const auto found = strips_.find(key_of(ix, iy));
    const std::uint32_t bit = bit_of(ix);
    if (found == strips_.end() || (found->second.mask & bit) == 0) return nullptr;
    return &found->second.values[found->second.before(bit)];
  }

  /// Returns the number of columns that have a value.
  std::size_t size() const { return size_; }

  /// Saves or loads all columns with their values. @throws InputError when loading a column that is
  /// not on the site.
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
  // Number of columns in a strip, one bit of Strip::mask each.
  static constexpr int kStrip = 32;
  // Number of values by which the memory of a strip grows.
  static constexpr std::size_t kMoreClearance = 4;

  // Values of up to 32 neighbouring columns of a row.
  struct Strip {
    // One bit per column of the strip, 1 if the column has a value.
    std::uint32_t mask = 0;
    // Values of the columns whose bit is 1, in ascending order of columns.
    std::vector<T> values;

    // Returns the number of columns with a value before the column whose bit is `bit`.
    std::size_t before(std::uint32_t bit) const {
      return static_cast<std::size_t>(std::popcount(mask & (bit - 1)));
    }
  };

  // Returns the number of strips in a row.
  std::int64_t strips_x() const { return (static_cast<std::int64_t>(nx_) + kStrip - 1) / kStrip; }
  // Returns the key in `strips_` of the strip that contains a column.
  std::int64_t key_of(int ix, int iy) const { return iy * strips_x() + ix / kStrip; }
  // Returns the bit of a column within the mask of its strip.
  static std::uint32_t bit_of(int ix) { return std::uint32_t{1} << (ix % kStrip); }

  // Loads `count` columns, which must be in ascending order.
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

  // Number of columns of the site in x and y direction.
  int nx_, ny_;
  // Number of columns that have a value.
  std::size_t size_ = 0;
  // Strips that contain a value, keyed by their row and position: in the order of the columns.
  std::map<std::int64_t, Strip> strips_;
};

}  // namespace navvy::coupling
