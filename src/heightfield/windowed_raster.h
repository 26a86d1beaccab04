// SPDX-License-Identifier: Apache-2.0
// A height map with more cells than fit in memory, read from its file in windows on demand.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/raster.h"

namespace navvy::heightfield {

/// A height map of any size. It gives bit-identical column heights to a HeightRaster with the same
/// cells. Any number of threads may query it.
///
/// The windows loaded last are in memory: at most kMostWindows of kSide x kSide cells (128 MiB).
/// The heights of filled gaps are in memory too. A height takes 20 ns longer than from a
/// HeightRaster if its window is in memory, and a read from the file otherwise.
class WindowedRaster {
 public:
  /// Number of cells along each side of a window.
  static constexpr int kSide = 256;
  /// Maximum number of windows in memory.
  static constexpr std::size_t kMostWindows = 512;

  /// Function that writes the heights of the map's `cells` to `out` [m], x fastest, NaN in gaps. It
  /// must be a pure function; only one thread at a time calls it. @throws InputError if the file
  /// cannot be read.
  using Source = std::function<void(const CellRect& cells, float* out)>;

  /// Makes a map with the size, cell edges and position of `frame`, whose heights are not used.
  /// `source` reads the heights. `side` is the number of cells along each side of a window; only
  /// tests change it.
  WindowedRaster(const HeightRaster& frame, Source source, int side = kSide);
  ~WindowedRaster();
  WindowedRaster(const WindowedRaster&) = delete;
  WindowedRaster& operator=(const WindowedRaster&) = delete;

  /// Fills gaps as heightfield::fill_gaps does, and stores the results in memory (30 bytes per
  /// gap). Must be called at most once, before any other query.
  /// @param gaps all cells without a known height, given by iy * nx + ix, in ascending order
  GapFill fill_gaps(std::vector<std::int64_t> gaps);

  /// Results of one pass over all cells of the map.
  struct Summary {
    /// Minimum (`least`) and maximum (`most`) height [m].
    float least = 0, most = 0;
    /// Distribution of the slopes, as heightfield::slopes computes it. The median has a relative
    /// accuracy of 1 in 30 000.
    SlopeRange slope;
    /// Hash of all heights (StateHash::bytes), followed by cell edges, position and size
    /// (StateHash::value).
    std::uint64_t hash = 0;
  };
  /// Reads the whole map once and returns its summary. The gaps must have been filled. `limit` is
  /// the slope [rad] for SlopeRange::share_above.
  Summary summary(double limit) const;

  /// Returns the mean height over a square with edge `edge` [m] around (x, y) [m], as
  /// HeightRaster::mean does.
  double mean(double x, double y, double edge) const;

 private:
  /// A rectangular block of cells that is in memory.
  struct Window;
  /// Windows in memory, with the lock that guards them.
  struct Cache;
  /// Returns the window that contains cell (ix, iy), and its neighbours at ix + 1 and iy + 1. Reads
  /// it from the file if it is not in memory. The reference is valid until this thread requests
  /// another window.
  const Window& window(int ix, int iy) const;
  /// Writes the heights of `cells` to `out` [m], x fastest, with filled gaps.
  void read(const CellRect& cells, float* out) const;
  /// Returns the index in `gaps_` of cell (ix, iy); -1 if the cell is not a gap.
  std::int64_t gap_at(int ix, int iy) const;

  /// Size, cell edges and position of the map; without heights.
  HeightRaster frame_;
  /// Function that reads heights from the file.
  Source source_;
  /// Number of cells along each side of a window, and number of windows along x.
  int side_, across_;
  /// Cells without a known height in the file, given by iy * nx + ix, in ascending order.
  std::vector<std::int64_t> gaps_;
  /// First gap of each row of cells, as an index into `gaps_`; one more entry contains the number
  /// of gaps. Empty if there are no gaps.
  std::vector<std::int64_t> row_begin_;
  /// Height that was filled in for each entry of `gaps_` [m].
  std::vector<float> filled_;
  /// Windows that are in memory, and their lock; never null.
  std::unique_ptr<Cache> cache_;
};

}  // namespace navvy::heightfield
