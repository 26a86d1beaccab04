// SPDX-License-Identifier: Apache-2.0
// Particles grouped by the column below them, for all rules of the exchange.
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

/// Returns the height of a particle above the datum [cells].
inline double height_in_cells(const Particle& p) {
  return static_cast<double>(kBlockCells) * p.block[2] + static_cast<double>(p.x[2]);
}

/// Particles that rest on one another on a column, without a gap below them. A pile is the loose
/// soil over a column wherever a rule needs the height of the ground with everything on it.
struct Pile {
  /// Height above the column [cells]: the larger of their volume in their density state and of the
  /// top of the highest one. The number of particles over one column scatters by 6 cm and would
  /// show slopes that do not exist [docs/exchange.md, deposit].
  double height = 0;
  /// [kMassQuantum].
  std::int64_t mass = 0;
  /// Centre of the highest one, or the column's surface without any [cells above datum].
  double top = 0;
};

/// Particles sorted by block, column and height, whatever their order. Time and memory are linear
/// in the particles. An index is made for each check and refers to the particles and the ground,
/// which must outlive it. Columns change while a check deposits soil; piles then still refer to the
/// ground before.
///
/// Every rule of the exchange reads the particles through it: rest and deposit by block, slopes and
/// support areas by column, activation by height within a column.
class ColumnIndex {
 public:
  /// Sorts the particles. A particle outside the site is listed under the column that would be
  /// below it. `grid`: position of blocks; tests that do not care leave it out.
  ColumnIndex(std::span<const Particle> particles, const heightfield::Ground& ground,
              PlanGrid grid = {});

  /// Returns the position of blocks among the columns.
  const PlanGrid& grid() const { return grid_; }

  /// Returns the blocks with particles, ascending.
  const std::vector<PlanKey>& blocks() const { return keys_; }
  /// Returns the position in `blocks`, or -1 without particles. Costs one hash lookup.
  int find(const PlanKey& block) const;

  /// Return the indices of the particles over a column (from the lowest up) or a block. The spans
  /// live as long as the index. They are empty where there are no particles.
  std::span<const std::uint32_t> column(int ix, int iy) const;
  std::span<const std::uint32_t> block(int b) const;
  /// Returns the pile on a column of the site. Without one, its top is the column's surface.
  Pile pile(int ix, int iy) const;
  /// Returns the height of the pile [cells], 0 without particles.
  double pile_height(int ix, int iy) const;

  /// Returns the particle of an index from `column` or `block`.
  const Particle& operator[](std::uint32_t i) const { return particles_[i]; }
  std::span<const Particle> particles() const { return particles_; }

 private:
  // Steps of the constructor: particles into columns, columns by height, and piles.
  void group();
  void sort_columns();
  void build_piles();
  // Returns the index of a column in `begin_` and `piles_`, or -1 when its block holds no particle.
  int slot(int ix, int iy) const;

  std::span<const Particle> particles_;
  const heightfield::Ground& ground_;
  PlanGrid grid_;
  std::vector<PlanKey> keys_;
  // Looked up only, never iterated.
  std::unordered_map<std::uint64_t, int> place_;
  // 16 per block and one end.
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> order_;
  // 16 per block.
  std::vector<Pile> piles_;
};

}  // namespace navvy::soil
