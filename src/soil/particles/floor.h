// SPDX-License-Identifier: Apache-2.0
// Which nodes resting ground holds: nodes at or below the highest of the four columns around them plus a quarter cell.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "heightfield/ground.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// Heights of held nodes per block, looked up from the ground only where the ground or the blocks changed.
class Floor {
 public:
  /// `held_margin` [cells]: nodes up to this far above the columns are held, too
  /// [docs/soil.md, resting ground].
  Floor(const heightfield::Ground& ground, PlanGrid grid, double held_margin = kScheme.held_margin)
      : ground_(&ground), grid_(grid), held_margin_(held_margin) {}

  /// Brings the list up to date for these active blocks; true when it changed since the last call.
  bool update(const std::vector<BlockKey>& active, bool blocks_changed);
  /// One per active block, in its order; heights from the block's corner [cells].
  const std::vector<BlockFloor>& blocks() const { return blocks_; }

 private:
  /// Of one column of blocks, with heights from the datum.
  BlockFloor make_patch(int bx, int by) const;

  const heightfield::Ground* ground_;
  PlanGrid grid_;
  double held_margin_;
  std::map<std::pair<int, int>, BlockFloor> patches_;  ///< by (bx, by)
  std::uint64_t sequence_ = 0;
  bool first_ = true;
  std::vector<BlockFloor> blocks_;
};

}  // namespace navvy::soil
