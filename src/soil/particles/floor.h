// SPDX-License-Identifier: Apache-2.0
// Which nodes resting ground holds: nodes at or below the highest of the four columns around them
// plus a quarter cell.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// Nodes up to this far above the columns are held too [cells] [docs/soil.md, resting ground].
inline constexpr double kHeldMargin = 0.25;

/// Heights of held nodes per block, looked up from the ground only where the ground or the blocks
/// changed.
class Floor {
 public:
  Floor(const heightfield::Ground& ground, PlanGrid grid) : ground_(&ground), grid_(grid) {}

  /// Brings the list up to date for these active blocks; true when it changed since the last call.
  bool update(const std::vector<BlockKey>& active, bool blocks_changed);
  /// One per active block, in its order; heights from the block's corner [cells].
  const std::vector<BlockFloor>& blocks() const { return blocks_; }

 private:
  /// Of one column of blocks, with heights from the datum.
  BlockFloor make_patch(int bx, int by) const;

  const heightfield::Ground* ground_;
  PlanGrid grid_;
  std::map<std::pair<int, int>, BlockFloor> patches_;  ///< by (bx, by)
  std::uint64_t sequence_ = 0;
  bool first_ = true;
  std::vector<BlockFloor> blocks_;
};

}  // namespace navvy::soil
