// SPDX-License-Identifier: Apache-2.0
#include "soil/current_transfer.h"

#include <span>
#include <utility>

#include "core/archive.h"

namespace navvy::soil {

double CurrentTransfer::end() {
  if (!interval_.open) return 0;
  transfer_.end(store_);
  contact_.end_transfer();
  return std::exchange(interval_, {}).motion;
}

void CurrentTransfer::visit(Archive& a) {
  a("interval", interval_);
  if (interval_.open) visit_nodes(a);
}

// Every active block, and the backs of those near a tool. Masses, and what lies near shells, follow
// from particles and poses.
void CurrentTransfer::visit_nodes(Archive& a) {
  if (a.loading()) {
    a("front", loaded_[0]);
    a("back", loaded_[1]);
    return;
  }
  const auto front =
      transfer_.velocity().map_read(0, store_.table().active.size() * 4 * BLOCK_NODES);
  std::span<const float> front_words = front.span();
  a("front", front_words);
  const auto back = contact_.nodes().velocity1.map_read(0, contact_.nodes().values());
  std::span<const float> behind = back.span();
  a("back", behind);
}

void CurrentTransfer::restore(Archive& a) {
  if (!interval_.open) return;
  a.require(loaded_[0].size() == store_.table().active.size() * 4 * BLOCK_NODES &&
                loaded_[1].size() == contact_.nodes().values(),
            "front", "must be four numbers for each node of the blocks that the particles reach");
  transfer_.velocity().write(loaded_[0]);
  if (!loaded_[1].empty()) contact_.nodes().velocity1.write(loaded_[1]);
  contact_.resume(transfer_);
}

}  // namespace navvy::soil
