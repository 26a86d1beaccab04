// SPDX-License-Identifier: Apache-2.0
// Finds resting columns that stand too high above what is near them (rule C).
#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "soil/exchange/activation_rules.h"
#include "soil/exchange/slump_table.h"

namespace navvy::soil {

/// A resting column that stands too high above another one `steps` columns away along (dx, dy). It
/// is a finding, not a request: the exchange decides whether the columns wake or slide.
struct OverSteep {
  int ix = 0, iy = 0;  ///< the high one
  int dx = 0, dy = 0;  ///< towards the low one
  int steps = 0;
  double low = 0;  ///< surface of the low one, with the soil on it [cells above datum]
};

/// Heights at which soil was last seen to stand: what particles came to rest at, and what lay
/// around them then. A drop that stood is not over-steep until it grows, or soil that the law holds
/// a little steeper than the slope rule would wake and be booked back for ever. It grows with the
/// area on which soil came to rest, 16 floats a block, and nothing is forgotten: where soil came to
/// rest once, that height stays known.
class StandingHeights {
 public:
  /// `grid` says where blocks begin, as in the index.
  explicit StandingHeights(PlanGrid grid) : grid_(grid) {}
  /// Remembers the columns of the blocks just `deposited`, and those of the blocks around them as
  /// they are now. `index` is from before the deposit.
  void remember(const heightfield::Ground& ground, const ColumnIndex& index,
                const std::set<PlanKey>& deposited);
  /// The height remembered [cells above datum]; false when there is none.
  bool find(int ix, int iy, double& height) const;

  /// Saved with the exchange, and hashed: two runs that differ in it wake other columns.
  void visit(Archive& a);

 private:
  PlanGrid grid_;
  std::map<PlanKey, std::array<float, kBlockCells * kBlockCells>> blocks_;
};

/// Looks at tiles of 32 x 32 columns.
///
/// The high column counts with its resting surface, the low one with the soil on it as well. On
/// ground that holds (`hold`) a drop that was there from the start is no reason, however steep, and
/// nowhere is one at which soil came to rest: only what grew is. Costs the tile and a margin of
/// SlumpTable::kReach; a tile without a drop worth looking at costs the reading of its heights.
class SlumpScan {
 public:
  // A tile of the ground, so that changed tiles are scanned whole.
  static constexpr int kTile = 32;

  /// The three must outlive the scan. `hold`: steep ground of the start stands, whatever the law
  /// says of it.
  SlumpScan(const heightfield::Ground& ground, const SlumpTable& table,
            const StandingHeights& standing, bool hold)
      : ground_(ground), table_(table), standing_(standing), hold_(hold) {}

  /// Appends what is over-steep in tile (tx, ty), or against it from outside, to `out`: for each
  /// column and direction the nearest drop. Drops across a tool that holds them are left out. (tx,
  /// ty) counts tiles from the site's corner. Zones say where tools are now.
  void scan(int tx, int ty, const ColumnIndex& index, std::span<const ToolZone> zones,
            std::vector<OverSteep>& out);

 private:
  // Heights of the tile and its margin, with and without what lies on them; outside the site they
  // are not asked.
  void read_window(int tx, int ty, const ColumnIndex& index);
  // One pair of columns; true when it was appended.
  bool look(int ix, int iy, int dx, int dy, int steps, std::span<const ToolZone> zones,
            std::vector<OverSteep>& out);
  std::size_t at(int ix, int iy) const {
    return static_cast<std::size_t>((iy - y0_) * kSide + ix - x0_);
  }
  // Whether the same drop stood at the start or when soil came to rest there.
  bool stood_before(int ix, int iy, int lx, int ly, double drop) const;
  // Whether a tool stands between the two, at the height of the drop.
  bool held_by_tool(const OverSteep& found, std::span<const ToolZone> zones, double high) const;

  // Columns of a window along one side: the tile and what a drop may reach over.
  static constexpr int kSide = kTile + 2 * SlumpTable::kReach;
  const heightfield::Ground& ground_;
  const SlumpTable& table_;
  const StandingHeights& standing_;
  bool hold_;
  int x0_ = 0, y0_ = 0;            // least column of the window
  std::vector<float> rest_, top_;  // surface without and with the soil on it [cells above datum]
  std::vector<heightfield::SoilLayer> layers_;
  double limit_[2][SlumpTable::kReach + 1] = {};  // weakest drop, [diagonal][steps] [cells]
};

}  // namespace navvy::soil
