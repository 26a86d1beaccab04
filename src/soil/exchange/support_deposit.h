// SPDX-License-Identifier: Apache-2.0
// Deposits active soil under wheels and tracks into the columns, which then carry their load
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

/// Returns true if a tool may touch the soil on column (ix, iy), whose surface is at `top`
/// [cells above datum]: if the box of a tool that has no resting contact is within one column in
/// plan and no more than a cell above the surface. Such soil belongs to the tool, as does
/// everything in a bucket or a truck bed.
bool tool_touches(std::span<const ToolZone> zones, int ix, int iy, double top);

/// Returns true if column (ix, iy), with the soil on it, is going to carry a support area and no
/// tool touches it. Such a column must not become active. Cost is one test per support area.
bool supports_machine(const heightfield::Ground& ground, const ColumnIndex& index,
                      std::span<const ToolZone> zones,
                      std::span<const SupportPlacement> support_areas, int ix, int iy);

/// Deposits the soil under support areas, whatever its speed. The mass of each soil is preserved
/// exactly.
///
/// Wheels and tracks act on columns only (ruts), so active soil must become columns before they
/// reach it.
///
/// The soil on a column is the stack of particles from the column's surface upwards without a gap,
/// by the same rule that maps use. All soil under one support area forms one pool, with the mean
/// density state and plastic shear. Each column's share is the smoothed height of columns and soil
/// minus the height of the column. Soil that would reach into the wheel stays active, so that soil
/// sliding under a wheel does not lift it. Cost is linear in the amount of soil under support
/// areas, and in the number of columns in their rectangles.
class SupportDeposit {
 public:
  /// Prepares deposits onto `ground`. All referenced arguments must outlive this object. `index`
  /// describes particles and ground before any deposit. `densest`: lowest volume ratio that
  /// deposited layers may have.
  SupportDeposit(heightfield::Ground& ground, const ColumnIndex& index,
                 std::span<const ToolZone> zones, double densest)
      : ground_(ground), index_(index), zones_(zones), densest_(densest) {}

  /// Deposits the soil under all support areas, one area after another; a column belongs to the
  /// first area that meets it. Sets the flags of deposited particles in `removed` (one entry per
  /// particle of the index) to 1, and adds their blocks to `blocks`. Returns the number of columns
  /// that received soil.
  int deposit(std::span<const SupportPlacement> support_areas, std::vector<std::uint8_t>& removed,
              std::set<PlanKey>& blocks);

 private:
  /// Particles that rest on a column, from bottom to top.
  struct Stack {
    /// Positions of the particles in the particle list of the ColumnIndex, from bottom to top.
    std::vector<std::uint32_t> grains;
    /// Volume of each particle in its density state, as a height over one column [m].
    std::vector<double> volumes;
    /// Height in W of the surface that the particles form [m].
    double top = 0;
    /// True if one of the particles is on a side of a tool's shell.
    bool touched = false;
  };
  /// Soil under one support area, and the columns that receive it.
  struct PendingDeposit {
    /// Columns and their shares.
    std::vector<SharedColumn> columns;
    /// Indices of the particles to be deposited.
    std::vector<std::uint32_t> grains;
  };
  /// Returns the particles that rest on column (ix, iy). Each column is computed once and cached.
  const Stack& stack(int ix, int iy);
  /// Returns the height in W of column (ix, iy) including the soil on it, smoothed over
  /// neighbouring columns [m].
  double smoothed(int ix, int iy);
  /// Collects the soil under one support area from columns that are not yet in `claimed`, and adds
  /// these columns to `claimed`.
  PendingDeposit plan(const SupportPlacement& area, std::set<PlanKey>& claimed);

  /// Columns of the site.
  heightfield::Ground& ground_;
  /// Particles before any deposit.
  const ColumnIndex& index_;
  /// Zones of the tools.
  std::span<const ToolZone> zones_;
  /// Lowest volume ratio of deposited layers.
  double densest_;
  /// Cache of `stack`, keyed by column.
  std::map<PlanKey, Stack> stacks_;
};

}  // namespace navvy::soil
