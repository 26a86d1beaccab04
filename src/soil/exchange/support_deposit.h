// SPDX-License-Identifier: Apache-2.0
// Deposits active soil under wheels and tracks into the columns, which then carry the load
// [docs/exchange.md, support areas].
#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "soil/exchange/activation_rules.h"
#include "soil/exchange/deposit_share.h"
#include "soil/exchange/support_area.h"

namespace navvy::soil {

/// Returns true if a tool's box reaches to within a column of (ix, iy) and to less than a cell
/// above the soil there, which ends at `top` [cells above datum]. Such soil belongs to the tool. So
/// does everything in a bucket or a bed.
bool tool_touches(std::span<const ToolZone> zones, int ix, int iy, double top);

/// Returns true if the column, with the soil on it, is to carry a support area and no tool touches
/// it. Such a column does not become active. Costs one test per support area.
bool supports_machine(const heightfield::Ground& ground, const ColumnIndex& index,
                      std::span<const ToolZone> zones,
                      std::span<const SupportPlacement> support_areas, int ix, int iy);

/// Deposits the soil under support areas, whatever its speed, mass-exact per soil.
///
/// Soil lies on a column by the stacking rule that maps use. All soil under one support area forms
/// one pool: density state and plastic shear are its means. The share of a column is the height of
/// columns and soil there, smoothed by the spline, minus the column. Soil that would reach into the
/// wheel stays active: soil that slides under a wheel does not lift it. Cost is linear in the soil
/// under support areas, and in the columns of their rectangles where there is any.
///
/// Wheels and tracks press on columns only (ruts), so soil under them must be columns before they
/// arrive.
class SupportDeposit {
 public:
  /// Deposits onto `ground`; ground, index and zones must outlive the object. The index is of the
  /// particles before anything is deposited. `densest`: lowest density state that columns take.
  SupportDeposit(heightfield::Ground& ground, const ColumnIndex& index,
                 std::span<const ToolZone> zones, double densest)
      : ground_(ground), index_(index), zones_(zones), densest_(densest) {}

  /// Deposits, one support area after the other; a column belongs to the first one that meets it.
  /// Marks deposited particles in `removed` and adds their blocks to `blocks`. Returns the number
  /// of columns that got soil.
  int deposit(std::span<const SupportPlacement> support_areas, std::vector<std::uint8_t>& removed,
              std::set<PlanKey>& blocks);

 private:
  /// Particles on a column, from below.
  struct Stack {
    std::vector<std::uint32_t> grains;
    /// Volumes in their density state [column area x m].
    std::vector<double> volumes;
    /// Height in W of the surface that they form [m].
    double top = 0;
    /// One of them is on a side of a shell.
    bool touched = false;
  };
  /// Soil under one support area, and the columns that will get it.
  struct PendingDeposit {
    std::vector<SharedColumn> columns;
    std::vector<std::uint32_t> grains;
  };
  /// Returns the particles on a column; each column is computed once.
  const Stack& stack(int ix, int iy);
  /// Returns the height of columns and soil on them, smoothed [m].
  double smoothed(int ix, int iy);
  /// Collects the soil under one support area from columns that are not in `claimed` yet.
  PendingDeposit plan(const SupportPlacement& area, std::set<PlanKey>& claimed);

  heightfield::Ground& ground_;
  const ColumnIndex& index_;
  std::span<const ToolZone> zones_;
  double densest_;
  std::map<PlanKey, Stack> stacks_;
};

}  // namespace navvy::soil
