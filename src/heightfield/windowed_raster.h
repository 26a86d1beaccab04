// SPDX-License-Identifier: Apache-2.0
// A map with more cells than fit in memory, read in windows on demand.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/raster.h"

namespace navvy::heightfield {

/// A HeightRaster of any size, with bit-identical columns. Any number of threads may query it.
///
/// Holds at most kMostWindows windows of kSide x kSide cells (128 MiB), the most recently read
/// ones, and the values of filled gaps. A height costs 20 ns more than from a HeightRaster where
/// its window is in memory, else a read from the file.
class WindowedRaster {
 public:
  /// Edge of a window in cells.
  static constexpr int kSide = 256;
  /// Largest number of windows in memory.
  static constexpr std::size_t kMostWindows = 512;

  /// Fills `out` with the heights [m] of some cells, x fastest, NaN in gaps. A pure function,
  /// called by one thread at a time. @throws InputError where the file cannot be read.
  using Source = std::function<void(const CellRect& cells, float* out)>;

  /// Uses size, cell and place of `frame`, whose z is empty. `side` is for tests.
  WindowedRaster(const HeightRaster& frame, Source source, int side = kSide);
  ~WindowedRaster();
  WindowedRaster(const WindowedRaster&) = delete;
  WindowedRaster& operator=(const WindowedRaster&) = delete;

  /// Fills gaps as heightfield::fill_gaps does. `gaps` are the cells without a height, iy * nx +
  /// ix, ascending. Must be called once, before any other query; costs 30 bytes per gap.
  GapFill fill_gaps(std::vector<std::int64_t> gaps);

  /// Results of one pass over all cells.
  struct Summary {
    /// Range of the heights [m].
    float least = 0, most = 0;
    /// Slopes as heightfield::slopes computes them; the median to 1 part in 30 000.
    SlopeRange slope;
    /// Hash of all z by StateHash::bytes, followed by the frame by StateHash::value.
    std::uint64_t hash = 0;
  };
  /// Reads the whole map once. No gaps may be left. `limit` is a slope [rad].
  Summary summary(double limit) const;

  /// Returns the mean height as HeightRaster::mean does [m].
  double mean(double x, double y, double edge) const;

 private:
  // A block of cells in memory.
  struct Window;
  struct Cache;
  /// Returns the window whose first cells include (ix, iy); valid until this thread asks for
  /// another.
  const Window& window(int ix, int iy) const;
  /// Reads cells with the values of filled gaps.
  void read(const CellRect& cells, float* out) const;
  /// Returns the number of a cell in gaps_; -1 where it is no gap.
  std::int64_t gap_at(int ix, int iy) const;

  HeightRaster frame_;
  Source source_;
  int side_, across_;
  // Cells without a height, ascending.
  std::vector<std::int64_t> gaps_;
  // Number of the first gap of each row; empty without gaps.
  std::vector<std::int64_t> row_begin_;
  // Height of each filled gap.
  std::vector<float> filled_;
  std::unique_ptr<Cache> cache_;
};

}  // namespace navvy::heightfield
