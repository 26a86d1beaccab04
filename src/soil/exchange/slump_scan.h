// SPDX-License-Identifier: Apache-2.0
// Finds resting columns that stand too high above their neighbourhood (rule C).
#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "soil/exchange/activation_rules.h"
#include "soil/exchange/slump_table.h"

namespace navvy::soil {

/// A resting column that stands too high above another one `steps` columns away along (dx, dy). It
/// is only a finding: the exchange decides whether the columns become active or slide.
struct OverSteep {
  /// The high column.
  int ix = 0, iy = 0;
  /// Direction of the low one.
  int dx = 0, dy = 0;
  /// Distance of the two columns [columns along the direction].
  int steps = 0;
  /// Surface of the low one, with the soil on it [cells above datum].
  double low = 0;
};

/// Heights at which soil has stood: where particles came to rest, and what lay around them. A drop
/// that stood is not over-steep until it grows. Otherwise soil that the law holds a little steeper
/// than the slope rule would become active and be deposited again for ever. Memory grows with the
/// area on which soil came to rest, 16 floats per block; nothing is forgotten.
class StandingHeights {
 public:
  /// Starts empty. `grid`: position of blocks, as in the index.
  explicit StandingHeights(PlanGrid grid) : grid_(grid) {}
  /// Stores the columns of the blocks just `deposited`, and those of the blocks around them as they
  /// are now. `index` is from before the deposit.
  void remember(const heightfield::Ground& ground, const ColumnIndex& index,
                const std::set<PlanKey>& deposited);
  /// Finds the stored height [cells above datum]. Returns false when there is none.
  bool find(int ix, int iy, double& height) const;

  /// Visits all heights. They are saved with the exchange and hashed: runs that differ in them
  /// activate other columns.
  void visit(Archive& a);

 private:
  PlanGrid grid_;
  std::map<PlanKey, std::array<float, kBlockCells * kBlockCells>> blocks_;
};

/// Examines tiles of 32 x 32 columns.
///
/// The high column counts with its resting surface, the low one with the soil on it as well. On
/// ground that holds (`hold`), a drop that was there at the start is no reason, however steep.
/// Nowhere is a drop at which soil came to rest; only its growth is. Cost is linear in the tile and
/// a margin of SlumpTable::kReach; a tile without a relevant drop costs only the reading of its
/// heights.
class SlumpScan {
 public:
  // Side of a tile of the ground [columns], so that changed tiles are scanned whole.
  static constexpr int kTile = 32;

  /// Reads ground, table and heights, which must outlive the scan. `hold`: steep ground of the
  /// start stands, whatever the law says.
  SlumpScan(const heightfield::Ground& ground, const SlumpTable& table,
            const StandingHeights& standing, bool hold)
      : ground_(ground), table_(table), standing_(standing), hold_(hold) {}

  /// Appends what is over-steep in tile (tx, ty), or against it from outside, to `out`: for each
  /// column and direction the nearest drop. Leaves out drops across a tool that holds them. (tx,
  /// ty) counts tiles from the site's corner. `zones`: present positions of tools.
  void scan(int tx, int ty, const ColumnIndex& index, std::span<const ToolZone> zones,
            std::vector<OverSteep>& out);

 private:
  // Reads the heights of the tile and its margin, with and without the soil on them, inside the
  // site.
  void read_window(int tx, int ty, const ColumnIndex& index);
  // Examines one pair of columns. Returns true when it was appended.
  bool look(int ix, int iy, int dx, int dy, int steps, std::span<const ToolZone> zones,
            std::vector<OverSteep>& out);
  /// Returns the index of a column of the window.
  std::size_t at(int ix, int iy) const {
    return static_cast<std::size_t>((iy - y0_) * kSide + ix - x0_);
  }
  // Returns true if the same drop stood at the start, or when soil came to rest there.
  bool stood_before(int ix, int iy, int lx, int ly, double drop) const;
  // Returns true if a tool stands between the two columns, at the height of the drop.
  bool held_by_tool(const OverSteep& found, std::span<const ToolZone> zones, double high) const;

  // Columns along one side of a window: the tile and the reach of drops.
  static constexpr int kSide = kTile + 2 * SlumpTable::kReach;
  const heightfield::Ground& ground_;
  const SlumpTable& table_;
  const StandingHeights& standing_;
  bool hold_;
  // Lowest column of the window.
  int x0_ = 0, y0_ = 0;
  // Surface without and with the soil on it [cells above datum].
  std::vector<float> rest_, top_;
  std::vector<heightfield::SoilLayer> layers_;
  // Smallest relevant drop, [diagonal][steps] [cells].
  double limit_[2][SlumpTable::kReach + 1] = {};
};

}  // namespace navvy::soil
