// SPDX-License-Identifier: Apache-2.0
// A map of more cells than are held at once: read in windows when its columns are asked for.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/raster.h"

namespace navvy::heightfield {

/// What a HeightRaster is, of any size: its columns have the same bits. Any number of threads may
/// ask it.
///
/// Holds at most kMostWindows windows of kSide x kSide cells (128 MiB), those that came in last,
/// and what its gaps were filled with. A height costs 20 ns more than from a HeightRaster where its
/// window is there, a read where it is not.
class WindowedRaster {
 public:
  static constexpr int kSide = 256;
  static constexpr std::size_t kMostWindows = 512;

  /// Fills `out` with the heights [m] of some cells, x fastest, NaN in gaps: a pure function,
  /// called by one thread at a time. @throws InputError where the file cannot be read.
  using Source = std::function<void(const CellRect& cells, float* out)>;

  /// Of `frame` size, cells and place count; its z is empty. `side` is for tests.
  WindowedRaster(const HeightRaster& frame, Source source, int side = kSide);
  ~WindowedRaster();
  WindowedRaster(const WindowedRaster&) = delete;
  WindowedRaster& operator=(const WindowedRaster&) = delete;

  /// As heightfield::fill_gaps. `gaps` are the cells without a height, iy * nx + ix, ascending. To
  /// be called once, before anything else is asked; costs 30 bytes a gap.
  GapFill fill_gaps(std::vector<std::int64_t> gaps);

  /// What one pass over all cells tells.
  struct Summary {
    float least = 0, most = 0;  ///< [m]
    SlopeRange slope;           ///< as heightfield::slopes; the median to 1 part in 30 000
    /// What StateHash::bytes makes of all z and StateHash::value of the frame behind them.
    std::uint64_t hash = 0;
  };
  /// Reads the whole map once. No gaps may be left.
  Summary summary(double limit) const;

  /// As HeightRaster::mean.
  double mean(double x, double y, double edge) const;

 private:
  struct Window;
  struct Cache;
  /// The window that holds cell (ix, iy) as its first ones do; valid until this thread asks for
  /// another.
  const Window& window(int ix, int iy) const;
  /// Cells with what gaps were filled with.
  void read(const CellRect& cells, float* out) const;
  /// Number in gaps_ of a cell; -1 where it is none.
  std::int64_t gap_at(int ix, int iy) const;

  HeightRaster frame_;
  Source source_;
  int side_, across_;
  std::vector<std::int64_t> gaps_;       // ascending
  std::vector<std::int64_t> row_begin_;  // of each row, the first of its gaps; empty without gaps
  std::vector<float> filled_;            // one for each gap
  std::unique_ptr<Cache> cache_;
};

}  // namespace navvy::heightfield
