// SPDX-License-Identifier: Apache-2.0
// Books soil that came to rest back into the columns, a block of 4 x 4 columns at a time.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "soil/exchange/activation_rules.h"
#include "soil/exchange/deposit_shape.h"
#include "soil/exchange/deposit_share.h"

namespace navvy::soil {

/// How long each block has been at rest [s], by block. Blocks that are not in it do not rest, so
/// the map is as long as the soil that came to rest since it woke.
using RestTimes = std::map<PlanKey, double>;

/// Times spent at rest, brought up to this check: `elapsed` is added where all particles of a block
/// move slowly, other blocks start again. A pure function of the particles, so their order does not
/// matter. Rest is told by the mass-weighted rms and by the fastest particle
/// [docs/exchange.md, rest]; a NaN speed is not at rest. Costs the particles.
void update_rest(const ColumnIndex& index, double elapsed, RestTimes& rest);

/// Whether a block may be booked back as far as rest, tools, neighbours and the site's edge say.
/// Voids come later. `block` is an entry of the index. True of blocks that have rested for 0.8 s
/// inside the site, with no tool near, touching or about to wake them, and nothing that moves in
/// the columns around.
bool may_deposit(const heightfield::Ground& ground, const ColumnIndex& index,
                 std::span<const ToolZone> zones, const RestTimes& rest, int block);

/// Books blocks back, mass-exact per soil.
///
/// The density state alone decides the volume: each soil of a block becomes one layer a column with
/// the mass-weighted mean j0 of its particles, clamped to [0.88, swell] (denser only where
/// particles crowd into much less room than that). The iso-surface decides how the block's volume
/// is spread over its columns; masses are shared in integers, what rounding leaves goes to the
/// highest column. Beside a cliff the iso-surface is round and would wear the edge a little at
/// every wake and deposit: columns there keep what lies over each of them, where it is ground still
/// bonded that makes a wall with its neighbours, not a spike of loose soil.
class Depositor {
 public:
  /// Both must outlive it. The index is of the particles as they are before anything is deposited;
  /// the ground changes under it, which its piles do not follow.
  Depositor(heightfield::Ground& ground, const ColumnIndex& index)
      : ground_(ground), index_(index) {}

  /// Deposits those of `blocks`, entries of the index, that are not hollow, and returns them. A
  /// hollow one waits until it has stood for 5 s; then its overhang or void, which columns cannot
  /// show, is booked as fallen in. All shapes are found before anything changes, so the order of
  /// the blocks does not matter. The caller drops the particles of the blocks returned; their mass
  /// is in the columns then, to the quantum.
  std::vector<int> deposit(std::span<const int> blocks, const RestTimes& rest);

 private:
  /// A block about to be booked: its surface, and which columns (x fastest) stand beside a cliff.
  struct Plan {
    BlockShape shape;
    std::array<bool, 16> cliff{};
  };
  // Indices of particles: over a block, or over those of its columns that share.
  using Grains = std::span<const std::uint32_t>;
  std::array<std::int64_t, 16> weights(const Plan& plan, int block) const;
  std::array<bool, 16> cliffs(int block) const;
  double surface(int ix, int iy) const;
  bool bonded(int ix, int iy) const;

  double crowding(const std::vector<SoilShare>& shares, const Plan& plan) const;
  void book(const Plan& plan, int block);
  void deposit_column(int ix, int iy);

  heightfield::Ground& ground_;
  const ColumnIndex& index_;
};

}  // namespace navvy::soil
