// SPDX-License-Identifier: Apache-2.0
// Sparse table of blocks: those that hold particles, those that hold nodes, and their neighbours.
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
  /// Orders by z, then y, then x.
  bool operator<(const BlockKey& other) const {
    return z != other.z ? z < other.z : y != other.y ? y < other.y : x < other.x;
  }
  BlockKey operator+(const BlockKey& d) const { return {x + d.x, y + d.y, z + d.z}; }
};

/// Returns the offset of neighbour n of 27 (x fastest, -1..1 on each axis), numbered as in the
/// kernels.
inline BlockKey neighbour_offset(int n) { return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}; }

/// Finds the index of a key in a list, by open addressing. It is only looked up, never iterated.
class BlockIndex {
 public:
  /// Replaces the list of keys, which must be unique.
  void build(const std::vector<BlockKey>& keys);
  /// Returns -1 when absent.
  int find(const BlockKey& key) const;

 private:
  std::vector<BlockKey> keys_;
  std::vector<int> slots_;
  std::size_t mask_ = 0;
};

/// Particle blocks (with particles) and active blocks (particle blocks and their 26 neighbours: all
/// nodes that particles can reach).
///
/// A particle of a block can reach nodes of that block and of its 26 neighbours before the next
/// re-bin. The table changes only when blocks appear or vanish. Building it costs the number of
/// particle blocks x 27.
struct BlockTable {
  /// Sorted.
  std::vector<BlockKey> particle_blocks;
  /// Sorted.
  std::vector<BlockKey> active;
  /// 27 per particle block: index of the neighbour among the active blocks.
  std::vector<int> neighbours;
  /// 27 per active block: index of the neighbour among the particle blocks, or -1.
  std::vector<int> around;
  BlockIndex particle_block_index, active_index;

  /// Builds the table from sorted, unique keys.
  void build(std::vector<BlockKey> sorted_keys);
};

}  // namespace navvy::soil
