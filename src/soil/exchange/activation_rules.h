// SPDX-License-Identifier: Apache-2.0
// Rules that select the columns to be activated, because of a tool (rule A) or because soil moves
// beside them (rule B) [docs/exchange.md, activation].
#pragma once

#include <map>
#include <span>
#include <vector>

#include "soil/exchange/exchange.h"
#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// A tool in the terms of the activation rules: column rectangles around the tool, the tool's
/// height range and its speed. Rectangles are clipped to the site and may be empty; column indices
/// start at the site's lower-left corner. A zone is computed at each check from the bounding box of
/// the tool's shell, so it changes when the tool turns.
struct ToolZone {
  /// Columns under the tool's bounding box.
  heightfield::CellRect box;
  /// Columns under the box and within two cells of it.
  heightfield::CellRect near;
  /// Columns to activate: the box extended by two dig depths in the direction of motion and by one
  /// on the other sides, times `scale`.
  heightfield::CellRect zone;
  /// Lowest and highest point of the tool's box [cells above datum].
  double low = 0, high = 0;
  /// Factor of the scene on the size of activation zones.
  double scale = 1;
  /// Speed of the centre of the tool's box [m/s].
  double speed = 0;
  /// Tool index that Solver::add_tool returned.
  int tool = -1;
  /// True if the tool stands on layered columns through a resting contact. While this is true, the
  /// tool neither turns columns into particles nor keeps particles active.
  bool supported = false;
  /// True if at least one column of the zone, with the soil on it, reaches up to within a cell of
  /// the tool's lowest point.
  bool engaged = false;

  /// Returns true if column (ix, iy) is under the box, whatever its height.
  bool touches(int ix, int iy) const { return contains(box, ix, iy); }
  /// Returns true if column (ix, iy) is inside the rectangle.
  static bool contains(const heightfield::CellRect& r, int ix, int iy) {
    return ix >= r.x0 && ix < r.x1 && iy >= r.y0 && iy < r.y1;
  }
};

/// Columns to activate: for each column the height [cells above datum] above which its soil becomes
/// particles. Columns that are not in the map remain columns. The map is ordered because new
/// particles are created in its order.
using ActivationPlan = std::map<PlanKey, double>;

/// Returns the zone of each tool, in the order of `tools`; no rule depends on that order. `scale`:
/// factor on the default size of the zones. Cost is linear in the number of columns in the zones.
std::vector<ToolZone> tool_zones(const heightfield::Ground& ground, const ColumnIndex& index,
                                 std::span<const ToolRegion> tools, double scale);

/// Applies rule A: for each engaged tool, adds to `plan` the columns of the tool's zone that reach
/// up to within a cell (times the scale) of the tool's lowest point. They are activated down to one
/// or two cells below that point.
///
/// The whole zone becomes active, not only the soil that the tool touches, because soil ahead of a
/// blade fails in a wedge at least as long as the blade's depth [docs/exchange.md, activation].
void activate_ahead_of_tools(const heightfield::Ground& ground, std::span<const ToolZone> zones,
                             ActivationPlan& plan);

/// Returns the particle speed above which soil counts as moving [m/s]: 5 % of the speed of the
/// slowest working tool, but at least 0.05 m/s, which is also the value if no tool is working. A
/// tool is working if it is engaged and faster than 0.1 m/s. A lower threshold would let the
/// elastic ringing of new particles activate the whole site.
double motion_threshold(std::span<const ToolZone> zones);

/// Applies rule B: a particle that has failed (large plastic shear) and is faster than `threshold`
/// [m/s] activates those of the 3 x 3 columns around it that reach up to its cell. The columns are
/// added to `plan`.
///
/// `may_activate(ix, iy)` returns true for columns to which this rule applies in this check. In the
/// zone of an engaged tool, activation reaches at most three cells (times the zone's scale) below
/// the tool. Cost is linear in the number of particles, plus nine columns for each column with
/// motion.
template <class MayActivate>
void activate_around_motion(const heightfield::Ground& ground, const ColumnIndex& index,
                            double threshold, std::span<const ToolZone> zones,
                            const MayActivate& may_activate, ActivationPlan& plan);

/// Adds to `plan` the activation of column (ix, iy) above the height `bottom` [cells above datum].
/// If the column is already in the plan, the deeper of the two requests remains.
void plan_activation(ActivationPlan& plan, int ix, int iy, double bottom);

// ---- implementation of the template

/// Finds the lowest particle in `column` (indices from ColumnIndex::column) that is faster than
/// `threshold` [m/s] and has failed. Sets `cell` to the height of its cell above the datum [cells]
/// and returns true; returns false if there is none.
bool lowest_motion(const ColumnIndex& index, std::span<const std::uint32_t> column,
                   double threshold, int& cell);
/// Decides whether motion in `cell` [cells above datum] activates the neighbouring column (ix, iy).
/// If so, sets `bottom` to the height above which the column becomes active [cells above datum] and
/// returns true; otherwise returns false.
bool activates_beside(const heightfield::Ground& ground, std::span<const ToolZone> zones, int ix,
                      int iy, int cell, double& bottom);

template <class MayActivate>
void activate_around_motion(const heightfield::Ground& ground, const ColumnIndex& index,
                            double threshold, std::span<const ToolZone> zones,
                            const MayActivate& may_activate, ActivationPlan& plan) {
  for (const PlanKey& block : index.blocks())
    for (int c = 0; c < kBlockCells * kBlockCells; ++c) {
      const int ix = index.grid().column_x(block, c), iy = index.grid().column_y(block, c);
      int cell = 0;
      if (!lowest_motion(index, index.column(ix, iy), threshold, cell)) continue;
      for (int y = iy - 1; y <= iy + 1; ++y)
        for (int x = ix - 1; x <= ix + 1; ++x) {
          double bottom = 0;
          if (ground.contains(x, y) && activates_beside(ground, zones, x, y, cell, bottom) &&
              may_activate(x, y))
            plan_activation(plan, x, y, bottom);
        }
    }
}

}  // namespace navvy::soil
