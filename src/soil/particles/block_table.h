// SPDX-License-Identifier: Apache-2.0
// Sparse table of particle blocks: blocks that contain particles, blocks whose nodes particles can
// reach, and the neighbours of both.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace navvy::soil {

/// Integer coordinates of a block in the grid frame G. Along x the block spans the cells 4 * x to 4
/// * x + 3, and likewise along y and z. Keys are ordered by z, then y, then x, so that the order of
/// sums does not depend on where on the site the soil is.
struct BlockKey {
  /// Coordinates in blocks; they may be negative.
  std::int32_t x = 0, y = 0, z = 0;
  /// Compares all three coordinates.
  bool operator==(const BlockKey&) const = default;
  /// Compares z first, then y, then x.
  bool operator<(const BlockKey& other) const {
    return z != other.z ? z < other.z : y != other.y ? y < other.y : x < other.x;
  }
  /// Returns the key shifted by `d` blocks.
  BlockKey operator+(const BlockKey& d) const { return {x + d.x, y + d.y, z + d.z}; }
};

/// Returns the offset of neighbour n, 0 .. 26, from a block: x varies fastest, each coordinate is
/// -1, 0 or 1, and n = 13 is the block itself. Kernels use the same numbering.
inline BlockKey neighbour_offset(int n) { return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}; }

/// Hash table that finds the index of a block key in a list. It supports look-up only, no
/// iteration.
class BlockIndex {
 public:
  /// Replaces the list of keys. The keys must be unique.
  void build(const std::vector<BlockKey>& keys);
  /// Returns the index of `key` in the list given to `build`, or -1 if it is not in the list.
  int find(const BlockKey& key) const;

 private:
  /// Keys in the order of the list.
  std::vector<BlockKey> keys_;
  /// Hash slots (open addressing): index into keys_, or -1 for a free slot.
  std::vector<int> slots_;
  /// Number of slots - 1; the number of slots is a power of two.
  std::size_t mask_ = 0;
};

/// Table of particle blocks and active blocks. A particle block contains particles. The active
/// blocks are the particle blocks and their 26 neighbours: together they contain all nodes that
/// particles can reach before the next re-bin.
///
/// The table changes only when a particle block appears or vanishes. Building it costs 27 look-ups
/// per particle block.
struct BlockTable {
  /// Keys of the particle blocks, ascending. The position in this list is the block's
  /// particle-block index.
  std::vector<BlockKey> particle_blocks;
  /// Keys of the active blocks, ascending. The position in this list is the block's active-block
  /// index.
  std::vector<BlockKey> active;
  /// 27 entries per particle block: active-block index of neighbour n (neighbour_offset). Every
  /// neighbour exists.
  std::vector<int> neighbours;
  /// 27 entries per active block: particle-block index of neighbour n, or -1 if that neighbour
  /// contains no particles.
  std::vector<int> around;
  /// Indices of the two lists: particle_block_index finds a key in `particle_blocks`, active_index
  /// in `active`.
  BlockIndex particle_block_index, active_index;

  /// Rebuilds the table from the keys of the particle blocks, which must be ascending and unique.
  void build(std::vector<BlockKey> sorted_keys);
};

}  // namespace navvy::soil
