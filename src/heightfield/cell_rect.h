// SPDX-License-Identifier: Apache-2.0
// Rectangles of terrain columns, and short lists of such rectangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A half-open rectangle of terrain columns: it contains column (ix, iy) if x0 <= ix < x1 and y0 <=
/// iy < y1.
struct CellRect {
  /// First column (x0, y0), and the column after the last one (x1, y1).
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// Returns true if the rectangle contains no column.
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  /// Returns true if column (ix, iy) lies in the rectangle.
  bool contains(int ix, int iy) const { return ix >= x0 && ix < x1 && iy >= y0 && iy < y1; }
  /// Returns true if this rectangle and `other` have at least one column in common.
  bool meets(const CellRect& other) const {
    return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
  }
  /// Returns the number of columns in the rectangle; 0 if it is empty.
  std::int64_t area() const { return empty() ? 0 : static_cast<std::int64_t>(x1 - x0) * (y1 - y0); }
  /// Returns the intersection of this rectangle with `other`. The result may be empty.
  CellRect cut(const CellRect& other) const;
  /// Grows this rectangle to the smallest one that contains both it and `other`. An empty `other`
  /// changes nothing.
  void include(const CellRect& other);
};

/// A set of changed columns, covered by at most kMost rectangles. Clients that hold a copy of a map
/// use it to find out which parts of the copy to refresh.
///
/// Rectangles that exactly fill a larger rectangle are replaced by that one. If the list then
/// exceeds kMost, the two rectangles whose union adds the fewest columns are merged. The list
/// therefore covers every column that was added, and covers nothing else until the first such
/// merge. Adding a rectangle takes about 100 ns.
class RectList {
 public:
  /// Maximum number of rectangles in the list.
  static constexpr std::size_t kMost = 64;
  /// Adds the columns of `rect` to the set. An empty rectangle has no effect.
  void add(const CellRect& rect);
  /// Returns the rectangles that cover the set. They may overlap. The result depends only on the
  /// sequence of calls of `add`.
  std::vector<CellRect> rects() const;

 private:
  /// A rectangle of the list with its best merge partner. Storing the partner makes finding the
  /// pair to merge a single pass over the list.
  struct Entry {
    /// Columns that this entry covers.
    CellRect rect;
    /// Index of this entry's best merge partner, which is the entry whose union with this one adds
    /// the fewest columns.
    std::size_t partner = 0;
    /// Number of columns that the union with `partner` covers and neither of the two entries does.
    std::int64_t added = 0;
  };
  /// Finds the best merge partner of entry `i`, and updates all entries for which `i` is now the
  /// best partner.
  void find_partner(std::size_t i);
  /// Removes entry `i` by moving the last entry to index `i`, and updates the partner indices.
  void erase(std::size_t i);

  /// Rectangles of the list, at most kMost between two calls of `add`.
  std::vector<Entry> entries_;
};

}  // namespace navvy::heightfield
