// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/floor.h"

#include <algorithm>
#include <iterator>

#include "soil/layout.h"
#include "soil/particles/particle.h"

namespace navvy::soil {
BlockFloor Floor::make_patch(int bx, int by) const {
  // Node i touches the columns i - 1 and i, so 4 x 4 nodes need 5 x 5 columns.
  std::vector<float> columns;
  const int x0 = grid_.column_x({by, bx}, 0) - 1, y0 = grid_.column_y({by, bx}, 0) - 1;
  ground_->copy_heights({x0, y0, x0 + 5, y0 + 5}, columns);
  const auto height = [&](int ix, int iy) {
    return (static_cast<double>(columns[static_cast<std::size_t>(ix + 5 * iy)]) -
            ground_->datum()) /
           ground_->cell();
  };
  BlockFloor patch;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      const double around[] = {height(x, y), height(x + 1, y), height(x, y + 1),
                               height(x + 1, y + 1)};
      const int node = x + 4 * y;
      patch.held[node] = static_cast<float>(
          *std::max_element(std::begin(around), std::end(around)) + held_margin_);
      for (int i = 0; i < 4; ++i) patch.around[node][i] = static_cast<float>(around[i]);
    }
  return patch;
}

// Patches are stored by column of blocks: all blocks above one another share a patch, and the
// ground changes in few places.
bool Floor::update(const std::vector<BlockKey>& active, bool blocks_changed) {
  const bool ground_changed = first_ || ground_->sequence() != sequence_;
  if (!ground_changed && !blocks_changed) return false;
  // Drop the patches whose 5 x 5 columns the change touches.
  if (ground_changed && !first_) {
    const heightfield::CellRect rect = ground_->changed_since(sequence_);
    std::erase_if(patches_, [&](const auto& entry) {
      const PlanKey block{entry.first.second, entry.first.first};
      const int x0 = grid_.column_x(block, 0) - 1, y0 = grid_.column_y(block, 0) - 1;
      return rect.x0 < x0 + 5 && rect.x1 > x0 && rect.y0 < y0 + 5 && rect.y1 > y0;
    });
  }
  sequence_ = ground_->sequence();
  first_ = false;

  // Keep only the patches of active blocks. Others are computed again when soil returns.
  std::map<std::pair<int, int>, BlockFloor> used;
  blocks_.resize(active.size());
  for (std::size_t b = 0; b < active.size(); ++b) {
    const std::pair<int, int> key{active[b].x, active[b].y};
    auto found = used.find(key);
    if (found == used.end()) {
      const auto known = patches_.find(key);
      found = used.emplace(key, known != patches_.end() ? known->second
                                                        : make_patch(key.first, key.second))
                  .first;
    }
    // Heights from the block's own corner preserve the precision of floats.
    const float corner = static_cast<float>(kBlockCells * active[b].z);
    blocks_[b] = found->second;
    for (float& height : blocks_[b].held) height -= corner;
    for (auto& node : blocks_[b].around)
      for (float& height : node) height -= corner;
  }
  patches_.swap(used);
  return true;
}

}  // namespace navvy::soil
