// SPDX-License-Identifier: Apache-2.0
// Rectangles of columns, and short lists of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A rectangle of columns, half open: x0 <= ix < x1, y0 <= iy < y1.
struct CellRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  /// Whether it holds column (ix, iy).
  bool contains(int ix, int iy) const { return ix >= x0 && ix < x1 && iy >= y0 && iy < y1; }
  /// Whether the two share a column.
  bool meets(const CellRect& other) const {
    return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
  }
  /// Number of columns; 0 when empty.
  std::int64_t area() const { return empty() ? 0 : static_cast<std::int64_t>(x1 - x0) * (y1 - y0); }
  /// The part that lies in `other` too; may be empty.
  CellRect cut(const CellRect& other) const;
  /// Grows to the smallest rectangle that holds both.
  void include(const CellRect& other);
};

/// A set of columns told by at most kMost rectangles, for who keeps a copy of a map and renews what
/// changed.
///
/// Rectangles that fill a larger one together become that one; when there are too many, the two
/// whose union adds the fewest columns are united. So the list covers everything added, exactly
/// while it is short. Adding one costs about 100 ns.
class RectList {
 public:
  static constexpr std::size_t kMost = 64;
  /// An empty rectangle adds nothing.
  void add(const CellRect& rect);
  /// In no particular but repeatable order; they may overlap.
  std::vector<CellRect> rects() const;

 private:
  // Partners are kept up to date, so that the pair to unite is found by one pass over the list.
  struct Entry {
    CellRect rect;
    std::size_t partner = 0;  // the one to unite it with: the union adds least
    std::int64_t added = 0;   // columns that the union would add
  };
  /// Looks for the partner of entry i and offers i to all others.
  void find_partner(std::size_t i);
  /// The last entry takes the place of i.
  void erase(std::size_t i);

  std::vector<Entry> entries_;
};

}  // namespace navvy::heightfield
