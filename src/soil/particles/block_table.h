// SPDX-License-Identifier: Apache-2.0
// The sparse table of blocks: which ones hold particles, which ones hold nodes, who is whose
// neighbour.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace navvy::soil {

/// Integer coordinates of a block in the grid frame G. Ordered by z, then y, then x, so that the
/// order of sums does not depend on where on the site the soil lies.
struct BlockKey {
  std::int32_t x = 0, y = 0, z = 0;
  bool operator==(const BlockKey&) const = default;
  bool operator<(const BlockKey& other) const {
    return z != other.z ? z < other.z : y != other.y ? y < other.y : x < other.x;
  }
  BlockKey operator+(const BlockKey& d) const { return {x + d.x, y + d.y, z + d.z}; }
};

/// Offset of neighbour n of 27 (x fastest, -1..1 each axis); same numbering as in the kernels.
inline BlockKey neighbour_offset(int n) { return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}; }

/// Finds the index of a key in a list; open addressing, looked up only, never iterated.
class BlockIndex {
 public:
  void build(const std::vector<BlockKey>& keys);
  int find(const BlockKey& key) const;  ///< -1 when absent

 private:
  std::vector<BlockKey> keys_;
  std::vector<int> slots_;
  std::size_t mask_ = 0;
};

/// Home blocks (with particles) and active blocks (homes and their 26 neighbours: all nodes
/// particles can reach).
struct BlockTable {
  std::vector<BlockKey> particle_blocks;  ///< sorted
  std::vector<BlockKey> active;           ///< sorted
  std::vector<int> neighbours;            ///< 27 per home: index of the neighbour among active
  std::vector<int> around;  ///< 27 per active: index of the neighbour among homes or -1
  BlockIndex particle_block_index, active_index;

  /// `homes` sorted and unique.
  void build(std::vector<BlockKey> sorted_keys);
};

}  // namespace navvy::soil
