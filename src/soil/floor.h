// SPDX-License-Identifier: Apache-2.0
// Which nodes resting ground holds: nodes at or below the highest of the four columns around them plus a quarter cell.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "heightfield/ground.h"
#include "soil/block_table.h"

namespace navvy::soil {

/// Heights of held nodes per block, looked up from the ground only where the ground or the blocks changed.
class Floor {
 public:
  explicit Floor(const heightfield::Ground& ground) : ground_(&ground) {}

  /// Brings the list up to date for these active blocks; true when it changed since the last call.
  bool update(const std::vector<BlockKey>& active, bool blocks_changed);
  /// 16 per active block (node columns, x fastest): nodes k <= value are held [cells from the block's corner].
  const std::vector<float>& heights() const { return heights_; }

 private:
  using Patch = std::array<float, 16>;  ///< highest column around each node column plus the margin [cells from datum]
  Patch make_patch(int bx, int by) const;

  const heightfield::Ground* ground_;
  std::map<std::pair<int, int>, Patch> patches_;
  std::uint64_t sequence_ = 0;
  bool first_ = true;
  std::vector<float> heights_;
};

}  // namespace navvy::soil
