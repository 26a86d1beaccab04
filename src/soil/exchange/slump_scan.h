// SPDX-License-Identifier: Apache-2.0
// Finds resting columns that are too high above their neighbourhood (rule C).
#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "soil/exchange/activation_rules.h"
#include "soil/exchange/slump_table.h"

namespace navvy::soil {

/// A resting column that is too high above another column, `steps` columns away in direction (dx,
/// dy). SlumpScan only reports it: the exchange decides whether the columns become active or slide.
struct OverSteep {
  /// Indices of the high column.
  int ix = 0, iy = 0;
  /// Direction towards the low column: each -1, 0 or 1, along an axis or a diagonal.
  int dx = 0, dy = 0;
  /// Number of steps (dx, dy) from the high to the low column.
  int steps = 0;
  /// Height of the low column, including the soil on it [cells above datum].
  double low = 0;
};

/// Heights at which soil has come to rest: columns where particles were deposited, and the columns
/// around them at that time.
///
/// A drop between two such columns is not over-steep unless it has grown since. Otherwise soil that
/// the soil law holds a little steeper than the slope rule would be activated and deposited again
/// and again. Memory grows with the area on which soil came to rest, 16 floats per block; entries
/// are never removed.
class StandingHeights {
 public:
  /// Creates an empty record. `grid`: offset of the blocks relative to the columns, as in the
  /// ColumnIndex.
  explicit StandingHeights(PlanGrid grid) : grid_(grid) {}
  /// Stores the current heights of the blocks `deposited`, and of the blocks around them including
  /// the particles on these. `index` must describe the particles before the deposit.
  void remember(const heightfield::Ground& ground, const ColumnIndex& index,
                const std::set<PlanKey>& deposited);
  /// Looks up the stored height of column (ix, iy). Sets `height` [cells above datum] and returns
  /// true; returns false if no height is stored.
  bool find(int ix, int iy, double& height) const;

  /// Visits all heights. They are saved and hashed with the exchange, because they influence which
  /// columns are activated.
  void visit(Archive& a);

 private:
  /// Offset of the blocks relative to the columns.
  PlanGrid grid_;
  /// Heights of the columns of each block, x fastest [cells above datum].
  std::map<PlanKey, std::array<float, kBlockCells * kBlockCells>> blocks_;
};

/// Searches tiles of 32 x 32 columns for drops that are too steep.
///
/// A drop is the height of the resting surface of the high column above the low column including
/// the soil on it. Two types of drops are accepted even if they are very steep: those that existed
/// at the start, if the scene's ground holds steep slopes (`hold`), and those at which soil came to
/// rest (StandingHeights). Such a drop is reported only if it has grown.
///
/// Cost is linear in the number of columns of the tile and of a margin of SlumpTable::kReach around
/// it. For a tile without a large drop only the heights are read.
class SlumpScan {
 public:
  /// Side of a tile [columns]. It is the size of the ground's tiles, so that tiles that changed are
  /// scanned as a whole.
  static constexpr int kTile = 32;

  /// Reads ground, table and standing heights, which must outlive this object. `hold`: true if
  /// steep slopes that exist at the start are stable, whatever the soil law says.
  SlumpScan(const heightfield::Ground& ground, const SlumpTable& table,
            const StandingHeights& standing, bool hold)
      : ground_(ground), table_(table), standing_(standing), hold_(hold) {}

  /// Appends to `out` the over-steep columns in tile (tx, ty), and those outside it whose low
  /// column is in the tile: for each column and direction the nearest drop. Drops across a tool
  /// that supports them are left out. (tx, ty): tile indices from the site's corner; `zones`:
  /// current zones of the tools.
  void scan(int tx, int ty, const ColumnIndex& index, std::span<const ToolZone> zones,
            std::vector<OverSteep>& out);

 private:
  /// Reads the heights of the tile and its margin, with and without the soil on the columns.
  void read_window(int tx, int ty, const ColumnIndex& index);
  /// Finds the largest drops from and to the columns of row iy of the tile whose first column is
  /// tile_x, up to `reach` columns away: fills `down_` and `up_`.
  void find_drops(int tile_x, int iy, int reach);
  /// Tests the drop from column (ix, iy) to the column `steps` away in direction (dx, dy). If it is
  /// too steep, appends it to `out` and returns true.
  bool look(int ix, int iy, int dx, int dy, int steps, std::span<const ToolZone> zones,
            std::vector<OverSteep>& out);
  /// Returns the position of column (ix, iy) in `rest_` and `top_`.
  std::size_t at(int ix, int iy) const {
    return static_cast<std::size_t>((iy - y0_) * kSide + ix - x0_);
  }
  /// Returns true if a drop of this size [cells] between (ix, iy) and (lx, ly) existed at the start
  /// or when soil came to rest there.
  bool stood_before(int ix, int iy, int lx, int ly, double drop) const;
  /// Returns true if a tool is between the two columns at the height of the drop. `high`: height of
  /// the high column [cells above datum].
  bool held_by_tool(const OverSteep& found, std::span<const ToolZone> zones, double high) const;

  /// Side of the window, i.e. of the tile with its margin [columns].
  static constexpr int kSide = kTile + 2 * SlumpTable::kReach;
  /// Columns of the site.
  const heightfield::Ground& ground_;
  /// Heights at which soil starts to slide.
  const SlumpTable& table_;
  /// Heights at which soil came to rest.
  const StandingHeights& standing_;
  /// True if steep slopes that exist at the start are stable.
  bool hold_;
  /// Lower-left column of the window.
  int x0_ = 0, y0_ = 0;
  /// Heights of the window's columns, x fastest [cells above datum]: rest_ without, top_ with the
  /// soil on the columns.
  std::vector<float> rest_, top_;
  /// Scratch memory: layers of one column.
  std::vector<heightfield::SoilLayer> layers_;
  /// Smallest drop that may be too steep [cells], indexed by [diagonal][steps].
  double limit_[2][SlumpTable::kReach + 1] = {};
  /// Largest excess of a drop over its limit, for each direction and each column of a row of the
  /// tile, with the column as the high one (down_) or the low one (up_) [cells]. Most columns have
  /// no drop near its limit, and need no further test.
  std::array<std::array<float, kTile>, 8> down_{}, up_{};
};

}  // namespace navvy::soil
