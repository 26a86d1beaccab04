// SPDX-License-Identifier: Apache-2.0
// What is remembered of some columns of a site: a sparse table by column.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/archive.h"

namespace navvy::coupling {

/// A value for each column that was ever asked for by `at`, walked and saved by iy * nx + ix as a
/// map of that key.
///
/// Columns of a row lie together, 32 to a strip, and a strip holds the values of those that have
/// one side by side: 3 bytes a column beside the value itself where a rut runs along the rows, 24
/// where one of four columns runs across them; a node of a map takes 56. To look a column up is to
/// search the strips, of which there are fewer than columns.
template <class T>
class ColumnTable {
 public:
  ColumnTable(int nx, int ny) : nx_(nx), ny_(ny) {}

  /// The value of a column of the site, made if it has none. Good until the next call.
  T& at(int ix, int iy) {
    Strip& strip = strips_[key_of(ix, iy)];
    const std::uint32_t bit = bit_of(ix);
    const auto place = static_cast<std::ptrdiff_t>(strip.before(bit));
    if ((strip.mask & bit) == 0) {
      // By a few at a time: doubling would leave a third unused.
      if (strip.values.size() == strip.values.capacity())
        strip.values.reserve(strip.values.size() + kMoreClearance);
      strip.values.emplace(strip.values.begin() + place);
      strip.mask |= bit;
      ++size_;
    }
    return strip.values[static_cast<std::size_t>(place)];
  }

  /// Null where the column has none.
  const T* find(int ix, int iy) const {
    const auto found = strips_.find(key_of(ix, iy));
    const std::uint32_t bit = bit_of(ix);
    if (found == strips_.end() || (found->second.mask & bit) == 0) return nullptr;
    return &found->second.values[found->second.before(bit)];
  }

  std::size_t size() const { return size_; }

  /// @throws InputError for a column beside the site.
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
  static constexpr int kStrip = 32;  // columns, a bit each
  static constexpr std::size_t kMoreClearance = 4;

  struct Strip {
    std::uint32_t mask = 0;  // which columns have a value
    std::vector<T> values;   // of those, in their order

    std::size_t before(std::uint32_t bit) const {
      return static_cast<std::size_t>(std::popcount(mask & (bit - 1)));
    }
  };

  std::int64_t strips_x() const { return (static_cast<std::int64_t>(nx_) + kStrip - 1) / kStrip; }
  std::int64_t key_of(int ix, int iy) const { return iy * strips_x() + ix / kStrip; }
  static std::uint32_t bit_of(int ix) { return std::uint32_t{1} << (ix % kStrip); }

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
  std::map<std::int64_t, Strip> strips_;  // by row, then along it: in the order of columns
};

}  // namespace navvy::coupling
