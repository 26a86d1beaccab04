// SPDX-License-Identifier: Apache-2.0
// Nodes held by resting ground. A node is held if it is no higher than the highest of the four
// columns around it plus a margin of a quarter of a cell; soil does not move at held nodes.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// Computes the heights of resting ground for every active block. The ground is read again only
/// where it, or the set of active blocks, has changed.
///
/// Four columns meet at a node, so a node is held if any of the four reaches it. All active blocks
/// above one another share a patch of heights for 4 x 4 node columns. Memory is 320 bytes per
/// active block.
class Floor {
 public:
  /// Starts without blocks. `ground` must outlive this object; `grid`: offset of the blocks
  /// relative to the columns; `held_margin`: nodes up to this height above the columns are held
  /// [cells] [docs/soil.md, resting ground].
  Floor(const heightfield::Ground& ground, PlanGrid grid, double held_margin = kScheme.held_margin)
      : ground_(&ground), grid_(grid), held_margin_(held_margin) {}

  /// Recomputes the list for the keys `active` of the active blocks, if the ground has changed or
  /// `blocks_changed` is true. Returns true if the list was recomputed.
  bool update(const std::vector<BlockKey>& active, bool blocks_changed);
  /// Returns the heights of resting ground, one entry per active block, in the order of the last
  /// `update`. Heights are relative to the block's lower corner [cells].
  const std::vector<BlockFloor>& blocks() const { return blocks_; }

 private:
  /// Returns the heights for the column of blocks at block coordinates (bx, by), relative to the
  /// datum [cells].
  BlockFloor make_patch(int bx, int by) const;

  /// Columns of the site.
  const heightfield::Ground* ground_;
  /// Offset of the blocks relative to the columns.
  PlanGrid grid_;
  /// Height above the columns up to which nodes are held [cells].
  double held_margin_;
  /// Heights relative to the datum [cells], keyed by the block coordinates (bx, by).
  std::map<std::pair<int, int>, BlockFloor> patches_;
  /// Sequence number of the ground's last change that patches_ includes.
  std::uint64_t sequence_ = 0;
  /// True until the first `update`.
  bool first_ = true;
  /// Result of the last `update`.
  std::vector<BlockFloor> blocks_;
};

}  // namespace navvy::soil
