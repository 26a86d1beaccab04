// SPDX-License-Identifier: Apache-2.0
// Awake particles grouped by the column they are over: what every rule of the exchange asks for.
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

/// Height of a particle above the datum [cells].
inline double height_in_cells(const Particle& p) {
  return static_cast<double>(kBlockCells) * p.block[2] + static_cast<double>(p.x[2]);
}

/// The particles that rest one on another on a column, without an empty gap below them. A pile
/// stands for the loose soil over a column wherever a rule asks how high the ground is with what
/// lies on it.
struct Pile {
  /// Above the column [cells]: the larger of their volume in their density state and of where the
  /// highest one ends. The number of particles over one column scatters by 6 cm and would show
  /// slopes that are none [docs/exchange.md, deposit].
  double height = 0;
  std::int64_t mass = 0;  ///< [kMassQuantum]
  /// Centre of the highest one, the column's surface when there is none [cells above datum].
  double top = 0;
};

/// Particles sorted by block, column and height. The order of the particles given does not matter.
/// Costs time and memory in proportion to the particles. It is made anew for each check and refers
/// to the particles and the ground it was made from, which must outlive it. Columns change under it
/// while a check books soil back; piles then still speak of the ground before.
class ColumnIndex {
 public:
  /// Sorts. A particle outside the site is kept under the column it would be over, though there is
  /// none. `grid` says where blocks begin; tests that do not care leave it out.
  ColumnIndex(std::span<const Particle> particles, const heightfield::Ground& ground,
              PlanGrid grid = {});

  const PlanGrid& grid() const { return grid_; }

  /// Blocks with particles, in rising order.
  const std::vector<PlanKey>& blocks() const { return keys_; }
  /// Position in `blocks`, -1 when no particle is over it. Costs one lookup in a hash table.
  int find(const PlanKey& block) const;

  /// Indices of the particles over a column or block, a column's from the lowest up. The spans live
  /// as long as the index. Both are empty where no particle is.
  std::span<const std::uint32_t> column(int ix, int iy) const;
  std::span<const std::uint32_t> block(int b) const;
  /// What rests on the column; its top is the column's surface when nothing does. (ix, iy) is a
  /// column of the site.
  Pile pile(int ix, int iy) const;
  /// Height of the pile alone [cells], 0 without particles.
  double pile_height(int ix, int iy) const;

  /// The particle of an index that `column` or `block` gave.
  const Particle& operator[](std::uint32_t i) const { return particles_[i]; }
  std::span<const Particle> particles() const { return particles_; }

 private:
  // The three steps of the constructor: particles into columns, each column by height, the pile of
  // each.
  void group();
  void sort_columns();
  void build_piles();
  // Number of a column in `begin_` and `piles_`; -1 when its block holds no particle.
  int slot(int ix, int iy) const;

  std::span<const Particle> particles_;
  const heightfield::Ground& ground_;
  PlanGrid grid_;
  std::vector<PlanKey> keys_;
  std::unordered_map<std::uint64_t, int> place_;  // looked up only, never walked
  std::vector<std::uint32_t> begin_;              // 16 per block and one end
  std::vector<std::uint32_t> order_;
  std::vector<Pile> piles_;  // 16 per block
};

}  // namespace navvy::soil
