// SPDX-License-Identifier: Apache-2.0
// Books awake soil that lies under wheels and belts into the columns, which bear them
// [docs/exchange.md, footings].
#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "soil/exchange/activation_rules.h"
#include "soil/exchange/deposit_share.h"
#include "soil/exchange/support_area.h"

namespace navvy::soil {

/// Whether a tool's box reaches to within a column of (ix, iy) and to less than a cell above the
/// soil there, which ends at `top` [cells above datum]. Then that soil is the tool's; what a bucket
/// or a bed holds always is.
bool tool_touches(std::span<const ToolZone> zones, int ix, int iy, double top);

/// Whether the column, with the soil that lies on it, is to bear a footing and no tool touches it:
/// such a column does not wake. Costs a look at each footing's rectangle.
bool supports_machine(const heightfield::Ground& ground, const ColumnIndex& index,
                      std::span<const ToolZone> zones,
                      std::span<const SupportPlacement> support_areas, int ix, int iy);

/// Takes what lies under footings, whatever its speed, and books it, mass-exact per soil.
///
/// What lies is told by stacking, as maps do. All that one footing takes is one pool: density state
/// and plastic shear are its means, and a column's share is the height of columns and lying soil
/// there, smoothed by the spline, over the column. Soil that would stand in the wheel stays what it
/// is: a wheel is not lifted by what slides under it. Costs the soil under footings, and the
/// columns of their rectangles where any is near.
class SupportDeposit {
 public:
  /// All must outlive it. The index is of the particles before anything is deposited.
  SupportDeposit(heightfield::Ground& ground, const ColumnIndex& index,
                 std::span<const ToolZone> zones)
      : ground_(ground), index_(index), zones_(zones) {}

  /// Deposits, footing by footing in their order; a column is the first one's that meets it. What
  /// is taken is marked in `removed`, its blocks are added to `blocks`.
  /// @return how many columns got soil.
  int deposit(std::span<const SupportPlacement> support_areas, std::vector<std::uint8_t>& removed,
              std::set<PlanKey>& blocks);

 private:
  /// Particles that lie on a column, from below.
  struct Stack {
    std::vector<std::uint32_t> grains;
    std::vector<double> volumes;  ///< in their density state [columns' area x m]
    double top = 0;               ///< W height of the surface that they make [m]
    bool touched = false;         ///< one of them is on a side of a shell
  };
  struct PendingDeposit {
    std::vector<SharedColumn> columns;
    std::vector<std::uint32_t> grains;
  };
  const Stack& stack(int ix, int iy);
  /// Height [m] of columns and lying soil, smoothed.
  double smoothed(int ix, int iy);
  PendingDeposit plan(const SupportPlacement& footing, std::set<PlanKey>& claimed);

  heightfield::Ground& ground_;
  const ColumnIndex& index_;
  std::span<const ToolZone> zones_;
  std::map<PlanKey, Stack> stacks_;
};

}  // namespace navvy::soil
