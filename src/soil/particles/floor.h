// SPDX-License-Identifier: Apache-2.0
// Nodes held by resting ground: those at or below the highest of the four columns around them, plus
// a quarter of a cell.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// Heights of held nodes per block. The ground is read only where it, or the set of blocks, has
/// changed.
///
/// Four columns meet at a node, so a node is held if any of them reaches it. All blocks of one
/// column of blocks share a patch of 4 x 4 heights; memory is 320 bytes per active block.
class Floor {
 public:
  /// Starts without blocks. `held_margin` [cells]: nodes up to this far above the columns are held
  /// [docs/soil.md, resting ground].
  Floor(const heightfield::Ground& ground, PlanGrid grid, double held_margin = kScheme.held_margin)
      : ground_(&ground), grid_(grid), held_margin_(held_margin) {}

  /// Updates the list for these active blocks. Returns true when it changed since the last call.
  bool update(const std::vector<BlockKey>& active, bool blocks_changed);
  /// Returns one entry per active block, in its order; heights from the block's corner [cells].
  const std::vector<BlockFloor>& blocks() const { return blocks_; }

 private:
  /// Computes one column of blocks, with heights from the datum.
  BlockFloor make_patch(int bx, int by) const;

  const heightfield::Ground* ground_;
  PlanGrid grid_;
  double held_margin_;
  /// Patches by (bx, by).
  std::map<std::pair<int, int>, BlockFloor> patches_;
  std::uint64_t sequence_ = 0;
  bool first_ = true;
  std::vector<BlockFloor> blocks_;
};

}  // namespace navvy::soil
