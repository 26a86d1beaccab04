// SPDX-License-Identifier: Apache-2.0
// Books soil that came to rest back into the columns, a block of 4 x 4 columns at a time.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "soil/deposit_shape.h"
#include "soil/wake_rules.h"

namespace navvy::soil {

/// How long each block has been at rest [s], by block.
using RestTimes = std::map<PlanKey, double>;

/// Times spent at rest, brought up to this check: `elapsed` is added where all particles of a block move slowly, other
/// blocks start again. A pure function of the particles, so their order does not matter.
void update_rest(const ColumnIndex& index, double elapsed, RestTimes& rest);

/// Whether a block may be booked back as far as rest, tools, neighbours and the site's edge say. Voids come later.
bool may_deposit(const heightfield::Ground& ground, const ColumnIndex& index, std::span<const ToolZone> zones,
                 const RestTimes& rest, int block);

/// Books blocks back, mass-exact per soil.
///
/// The density state alone decides the volume: each soil of a block becomes one layer a column with the mass-weighted
/// mean j0 of its particles, clamped to [0.88, swell] (denser only where particles crowd into much less room than
/// that). The iso-surface decides how the block's volume is spread over its columns; masses are shared in integers,
/// what rounding leaves goes to the highest column.
class Depositor {
 public:
  Depositor(heightfield::Ground& ground, const ColumnIndex& index) : ground_(ground), index_(index) {}

  /// Deposits those of `blocks`, entries of the index, that are not hollow, and returns them. All shapes are found
  /// before anything changes, so the order of the blocks does not matter.
  std::vector<int> deposit(std::span<const int> blocks);

 private:
  struct Share {  // of one soil of a block
    std::uint16_t soil = 0;
    std::int64_t mass = 0;
    double volume = 0, shear = 0, height = 0;  // mass-weighted sums
  };
  std::vector<Share> shares(int block) const;
  std::array<std::int64_t, 16> weights(const BlockShape& shape, int block) const;

  double crowding(const std::vector<Share>& shares, const BlockShape& shape) const;
  void book(const BlockShape& shape, int block);

  heightfield::Ground& ground_;
  const ColumnIndex& index_;
};

}  // namespace navvy::soil
