// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/block_table.h"

#include <algorithm>

namespace navvy::soil {
namespace {

/// Mixes the bits so that neighbouring blocks do not form long probe sequences.
std::size_t scatter_bits(const BlockKey& key) {
  std::uint64_t h = static_cast<std::uint32_t>(key.x) * 0x9e3779b97f4a7c15ULL;
  h ^= static_cast<std::uint32_t>(key.y) * 0xc2b2ae3d27d4eb4fULL;
  h ^= static_cast<std::uint32_t>(key.z) * 0x165667b19e3779f9ULL;
  return static_cast<std::size_t>(h ^ (h >> 29));
}

}  // namespace

void BlockIndex::build(const std::vector<BlockKey>& keys) {
  keys_ = keys;
  // At most a third full: a search ends after a step or two.
  std::size_t size = 16;
  while (size < 3 * keys.size()) size *= 2;
  mask_ = size - 1;
  slots_.assign(size, -1);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::size_t at = scatter_bits(keys[i]) & mask_;
    while (slots_[at] >= 0) at = (at + 1) & mask_;
    slots_[at] = static_cast<int>(i);
  }
}

int BlockIndex::find(const BlockKey& key) const {
  if (slots_.empty()) return -1;
  for (std::size_t at = scatter_bits(key) & mask_; slots_[at] >= 0; at = (at + 1) & mask_)
    if (keys_[static_cast<std::size_t>(slots_[at])] == key) return slots_[at];
  return -1;
}

void BlockTable::build(std::vector<BlockKey> sorted_keys) {
  particle_blocks = std::move(sorted_keys);
  particle_block_index.build(particle_blocks);
  active.clear();
  active.reserve(particle_blocks.size() * 4);
  // All nodes that particles of the blocks can reach before the next re-bin.
  for (const BlockKey& particle_block : particle_blocks)
    for (int n = 0; n < 27; ++n) active.push_back(particle_block + neighbour_offset(n));
  std::sort(active.begin(), active.end());
  active.erase(std::unique(active.begin(), active.end()), active.end());
  active_index.build(active);

  neighbours.resize(27 * particle_blocks.size());
  for (std::size_t h = 0; h < particle_blocks.size(); ++h)
    for (int n = 0; n < 27; ++n)
      neighbours[27 * h + static_cast<std::size_t>(n)] =
          active_index.find(particle_blocks[h] + neighbour_offset(n));
  // Neighbour n of a particle block has that block as its neighbour 26 - n.
  around.assign(27 * active.size(), -1);
  for (std::size_t h = 0; h < particle_blocks.size(); ++h)
    for (std::size_t n = 0; n < 27; ++n)
      around[27 * static_cast<std::size_t>(neighbours[27 * h + n]) + 26 - n] = static_cast<int>(h);
}

}  // namespace navvy::soil
