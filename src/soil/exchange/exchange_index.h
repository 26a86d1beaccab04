// SPDX-License-Identifier: Apache-2.0
// Index of the particles by the column below them, which all rules of the exchange use.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/particles/particle.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// Returns the height of a particle's centre above the datum [cells].
inline double height_in_cells(const Particle& p) {
  return static_cast<double>(kBlockCells) * p.block[2] + static_cast<double>(p.x[2]);
}

/// Loose soil on one column: particles that rest on the column and on one another, without a gap.
/// Rules use it to find the height of the ground including the soil on it.
struct Pile {
  /// Height of the pile above the column's surface [cells]. It is the larger of the height that the
  /// particles' volume in the density state gives, and the top of the highest particle. A height
  /// from the number of particles would scatter by 6 cm from column to column and show slopes that
  /// do not exist [docs/exchange.md, deposit].
  double height = 0;
  /// Mass of the pile [kMassQuantum].
  std::int64_t mass = 0;
  /// Centre of the highest particle or, without particles, the surface of the column
  /// [cells above datum].
  double top = 0;
};

/// Particles sorted by block, column and height, independent of their order in the input.
///
/// An index is built for each check. It refers to the particles and the ground, which must outlive
/// it. While a check deposits soil the columns change; piles still describe the state before.
///
/// All rules of the exchange read particles through it: rest and deposit by block, slopes and
/// support areas by column, activation by height within a column. Time and memory are linear in the
/// number of particles.
class ColumnIndex {
 public:
  /// Sorts the particles. A particle outside the site is listed under the column that would be
  /// below it. `grid`: offset of the blocks relative to the columns; the default places a block at
  /// the site's corner. `without`: one flag per particle, not 0 for those that are not listed, or
  /// empty.
  ColumnIndex(std::span<const Particle> particles, const heightfield::Ground& ground,
              PlanGrid grid = {}, std::span<const std::uint8_t> without = {});

  /// Returns the offset of the blocks relative to the columns.
  const PlanGrid& grid() const { return grid_; }

  /// Returns the keys of the blocks that contain particles, ascending.
  const std::vector<PlanKey>& blocks() const { return keys_; }
  /// Returns the position of `block` in blocks(), or -1 if it contains no particles. Costs one hash
  /// look-up.
  int find(const PlanKey& block) const;

  /// Returns the indices of the particles over column (ix, iy), from bottom to top; empty if there
  /// are none. The span is valid as long as the index.
  std::span<const std::uint32_t> column(int ix, int iy) const;
  /// Returns the indices of the particles over the block at position `b` of blocks(), column by
  /// column. The span is valid as long as the index.
  std::span<const std::uint32_t> block(int b) const;
  /// Returns the pile on column (ix, iy). Without particles its height and mass are 0, and its top
  /// is the surface of the column.
  Pile pile(int ix, int iy) const;
  /// Returns the height of the pile on column (ix, iy) [cells]; 0 without particles.
  double pile_height(int ix, int iy) const;

  /// Returns the particle with index i, as `column` and `block` return it.
  const Particle& operator[](std::uint32_t i) const { return particles_[i]; }
  /// Returns the number of particles that are listed.
  std::size_t count() const { return order_.size(); }

 private:
  /// Groups the particles by block and column.
  void group(std::span<const std::uint8_t> without);
  /// Sorts the particles of each column by height.
  void sort_columns();
  /// Computes the pile on each column of the blocks.
  void build_piles();
  /// Returns the position of column (ix, iy) in `begin_` and `piles_`, or -1 if its block contains
  /// no particles.
  int slot(int ix, int iy) const;

  /// Particles given to the constructor.
  std::span<const Particle> particles_;
  /// Columns of the site.
  const heightfield::Ground& ground_;
  /// Offset of the blocks relative to the columns.
  PlanGrid grid_;
  /// Keys of the blocks with particles, ascending.
  std::vector<PlanKey> keys_;
  /// Position in `keys_`, keyed by the packed block key. It is only looked up and never iterated,
  /// because its order is not repeatable.
  std::unordered_map<std::uint64_t, int> place_;
  /// Start of each column's particles in `order_`: 16 entries per block and a final end.
  std::vector<std::uint32_t> begin_;
  /// Particle indices, column by column and from bottom to top.
  std::vector<std::uint32_t> order_;
  /// Piles, 16 per block.
  std::vector<Pile> piles_;
};

}  // namespace navvy::soil
