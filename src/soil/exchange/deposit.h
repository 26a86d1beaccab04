// SPDX-License-Identifier: Apache-2.0
// Deposits soil that has come to rest into the columns, one block of 4 x 4 columns at a time.
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

/// Time for which each block has been at rest [s], keyed by block. Blocks that are not in the map
/// are not at rest. The map grows with the area on which active soil has come to rest.
using RestTimes = std::map<PlanKey, double>;

/// Updates the rest times: adds `elapsed` [s] to blocks whose particles all move slowly, and
/// removes all other blocks. The criterion combines the mass-weighted rms speed with the speed of
/// the fastest particle [docs/exchange.md, rest]; a block with a NaN speed is not at rest. The
/// result does not depend on the order of the particles. Cost is linear in their number.
void update_rest(const ColumnIndex& index, double elapsed, RestTimes& rest);

/// Returns true if a block may be deposited as far as rest, tools, neighbours and the site's edge
/// are concerned; voids are checked later. `block`: position of the block in ColumnIndex::blocks.
///
/// A block may be deposited if it has rested for 0.8 s, lies inside the site, nothing moves in the
/// columns around it, and no tool is near it, touches it or is about to activate it.
bool may_deposit(const heightfield::Ground& ground, const ColumnIndex& index,
                 std::span<const ToolZone> zones, const RestTimes& rest, int block);

/// Deposits blocks of particles into the columns below them. The mass of each soil is preserved
/// exactly.
///
/// Only the density state of the particles determines the deposited volume: each soil of a block
/// becomes one layer per column, with the mass-weighted mean j0 of its particles, limited to
/// `densest` .. swell. Where particles crowd into a much smaller volume, the layer is made denser.
/// The iso-surface of the soil (BlockShape) determines how the volume is distributed over the
/// columns. Masses are divided in integers; the column with the largest share receives the
/// remainder.
///
/// A column is at a cliff if its surface differs from that of a neighbouring column by more than
/// 1.5 cells. There the iso-surface is rounded, so every activation and deposit would erode the
/// edge a little. Columns at a cliff therefore keep the soil above each of them, if that soil is
/// still bonded and forms a wall with its neighbours rather than a spike of loose soil.
class Depositor {
 public:
  /// Prepares deposits onto `ground`. Ground and index must outlive this object. `index` describes
  /// particles and ground before any deposit and is not updated. `densest`: lowest volume ratio
  /// that deposited layers may have.
  Depositor(heightfield::Ground& ground, const ColumnIndex& index, double densest)
      : ground_(ground), index_(index), densest_(densest) {}

  /// Deposits those of `blocks` that are not hollow, and returns them. Blocks are given and
  /// returned as positions in ColumnIndex::blocks.
  ///
  /// A hollow block has a void or an overhang, which columns cannot represent. It is deposited only
  /// after it has rested for 5 s, as if the void had collapsed. The shapes of all blocks are
  /// computed before the first deposit, so the order of `blocks` does not matter. The caller must
  /// remove the particles of the returned blocks; their mass is in the columns exactly.
  std::vector<int> deposit(std::span<const int> blocks, const RestTimes& rest);

 private:
  /// Surface of a block to be deposited, and its columns at a cliff.
  struct Plan {
    /// Surface of the soil over the block.
    BlockShape shape;
    /// True for columns at a cliff, x fastest.
    std::array<bool, 16> cliff{};
  };
  /// Indices of particles, as ColumnIndex::column returns them.
  using Grains = std::span<const std::uint32_t>;
  /// Returns the integer share of each column of the block in the block's volume, x fastest; 0 for
  /// columns at a cliff.
  std::array<std::int64_t, 16> weights(const Plan& plan, int block) const;
  /// Returns one flag per column of the block, x fastest: true if the column is at a cliff and
  /// keeps its own soil.
  std::array<bool, 16> cliffs(int block) const;
  /// Returns the height of column (ix, iy) with the soil on it [cells above datum].
  double surface(int ix, int iy) const;
  /// Returns true if at least a quarter of the active soil over column (ix, iy) has little plastic
  /// shear.
  bool bonded(int ix, int iy) const;

  /// Returns the volume that the soil of a block needs in its density state, divided by the volume
  /// under the block's surface; columns at a cliff are left out.
  double crowding(const std::vector<SoilShare>& shares, const Plan& plan) const;
  /// Deposits one block: each column at a cliff separately, all other columns from one pool of
  /// soil.
  void deposit_block(const Plan& plan, int block);
  /// Deposits the soil over one column at a cliff into that column.
  void deposit_column(int ix, int iy);

  /// Columns of the site.
  heightfield::Ground& ground_;
  /// Particles before any deposit.
  const ColumnIndex& index_;
  /// Lowest volume ratio of deposited layers.
  double densest_;
};

}  // namespace navvy::soil
