// SPDX-License-Identifier: Apache-2.0
// Deposits soil that came to rest into the columns, one block of 4 x 4 columns at a time.
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

/// Time that each block has been at rest [s]. Blocks that are not listed are not at rest, so the
/// map grows with the soil that came to rest since it became active.
using RestTimes = std::map<PlanKey, double>;

/// Updates the times at rest: adds `elapsed` [s] where all particles of a block move slowly, and
/// restarts other blocks. The result does not depend on the order of particles. Rest is judged by
/// the mass-weighted rms velocity and by the fastest particle [docs/exchange.md, rest]; a NaN speed
/// is not at rest. Cost is linear in the particles.
void update_rest(const ColumnIndex& index, double elapsed, RestTimes& rest);

/// Returns true if rest, tools, neighbours and the site's edge allow to deposit a block; voids are
/// checked later. `block` is an entry of the index. Such a block has rested for 0.8 s inside the
/// site, no tool is near, touches it or is about to activate it, and nothing moves in the columns
/// around it.
bool may_deposit(const heightfield::Ground& ground, const ColumnIndex& index,
                 std::span<const ToolZone> zones, const RestTimes& rest, int block);

/// Deposits blocks, mass-exact per soil.
///
/// The density state alone decides the volume: each soil of a block becomes one layer per column
/// with the mass-weighted mean j0 of its particles, limited to [0.88, swell] (denser only where
/// particles crowd into much less volume). The iso-surface decides how the volume is spread over
/// the columns. Masses are shared in integers; the highest column takes what rounding leaves.
///
/// Beside a cliff the iso-surface is rounded and would wear the edge a little with every activation
/// and deposit. Columns there keep the soil above each of them if it is still bonded and forms a
/// wall with its neighbours, not a spike of loose soil.
class Depositor {
 public:
  /// Deposits onto `ground`; ground and index must outlive the object. The index is of the
  /// particles before anything is deposited; the ground changes under it, which its piles do not
  /// follow. `densest`: lowest density state that columns take.
  Depositor(heightfield::Ground& ground, const ColumnIndex& index, double densest)
      : ground_(ground), index_(index), densest_(densest) {}

  /// Deposits those of `blocks`, entries of the index, that are not hollow, and returns them. A
  /// hollow block waits until it has rested for 5 s; then its overhang or void, which columns
  /// cannot represent, counts as collapsed. All shapes are found before anything changes, so the
  /// order of the blocks does not matter. The caller removes the particles of the returned blocks;
  /// their mass is in the columns, exact to the quantum.
  std::vector<int> deposit(std::span<const int> blocks, const RestTimes& rest);

 private:
  /// Surface of a block to be deposited, and its columns (x fastest) beside a cliff.
  struct Plan {
    BlockShape shape;
    std::array<bool, 16> cliff{};
  };
  // Indices of the particles over a block, or over those of its columns that share.
  using Grains = std::span<const std::uint32_t>;
  /// Returns the integer share of each column of a block in its volume.
  std::array<std::int64_t, 16> weights(const Plan& plan, int block) const;
  /// Returns the columns of a block that stand beside a cliff.
  std::array<bool, 16> cliffs(int block) const;
  /// Returns the surface of a column with the soil on it [cells above datum].
  double surface(int ix, int iy) const;
  /// Returns true if a good part of the soil over a column was hardly sheared.
  bool bonded(int ix, int iy) const;

  /// Returns the volume in the density state over the volume that the soil has.
  double crowding(const std::vector<SoilShare>& shares, const Plan& plan) const;
  /// Deposits one block: columns at a cliff by themselves, the others from one pool.
  void deposit_block(const Plan& plan, int block);
  /// Deposits the soil over one column at a cliff.
  void deposit_column(int ix, int iy);

  heightfield::Ground& ground_;
  const ColumnIndex& index_;
  double densest_;
};

}  // namespace navvy::soil
