// SPDX-License-Identifier: Apache-2.0
// Rules for columns that become active because of a tool (rule A) or because soil moves beside them
// (rule B) [docs/exchange.md, activation].
#pragma once

#include <map>
#include <span>
#include <vector>

#include "soil/exchange/exchange.h"
#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// A tool as columns see it. Rectangles lie inside the site and may be empty. It is computed at
/// each check from the shell's box, so it changes when the tool turns. Heights are in cells above
/// the datum, columns are counted from the site's corner.
struct ToolZone {
  /// Columns under the tool's box.
  heightfield::CellRect box;
  /// Columns within kToolGuard of it.
  heightfield::CellRect near;
  /// Columns to activate: two dig depths ahead and one to the sides, times the scene's factor.
  heightfield::CellRect zone;
  /// Heights of the box [cells above datum].
  double low = 0, high = 0;
  /// Factor of the scene on the size of zones.
  double scale = 1;
  /// [m/s].
  double speed = 0;
  /// Index from add_tool.
  int tool = -1;
  /// The tool stands: no soil becomes or stays active because of it.
  bool supported = false;
  /// Some column of the zone, with the soil on it, reaches up to it.
  bool engaged = false;

  /// Returns true for a column under the box in plan, at any height.
  bool touches(int ix, int iy) const { return contains(box, ix, iy); }
  /// Returns true for a column inside a rectangle.
  static bool contains(const heightfield::CellRect& r, int ix, int iy) {
    return ix >= r.x0 && ix < r.x1 && iy >= r.y0 && iy < r.y1;
  }
};

/// Height [cells above datum] above which each column becomes active. Columns that are not listed
/// stay. It is ordered, as new particles come in its order.
using ActivationPlan = std::map<PlanKey, double>;

/// Returns the zones of all tools, `scale` times as large as by default, in the order of `tools`;
/// no rule depends on that order. Cost is linear in the columns of the zones.
std::vector<ToolZone> tool_zones(const heightfield::Ground& ground, const ColumnIndex& index,
                                 std::span<const ToolRegion> tools, double scale);

/// Rule A: activates columns of the zone that reach within a cell (times the scale) of the tool's
/// lowest point, down to one or two cells below it.
///
/// The whole zone becomes active, not only what a tool touches, because soil fails ahead of a blade
/// in a wedge at least as long as its depth [docs/exchange.md, activation].
void activate_ahead_of_tools(const heightfield::Ground& ground, std::span<const ToolZone> zones,
                             ActivationPlan& plan);

/// Returns the speed above which soil counts as moving [m/s]: 5 % of that of the slowest working
/// tool, at least 0.05 m/s, also without a working tool. Below, the elastic ringing of new
/// particles would activate the whole site.
double motion_threshold(std::span<const ToolZone> zones);

/// Rule B: a particle that has failed (plastic shear) and is faster than `threshold` [m/s]
/// activates the 3 x 3 columns around it that reach up to its cell. `may_activate` returns true for
/// a column to which this rule applies now. In the zone of a working tool it goes no deeper than
/// three cells below the tool. Cost is linear in the particles, and nine columns for each column
/// that moves.
template <class MayActivate>
void activate_around_motion(const heightfield::Ground& ground, const ColumnIndex& index,
                            double threshold, std::span<const ToolZone> zones,
                            const MayActivate& may_activate, ActivationPlan& plan);

/// Adds a request. Of two for one column the deeper one remains.
void plan_activation(ActivationPlan& plan, int ix, int iy, double bottom);

// ---- implementation of the template

/// Finds the lowest cell with a flowing particle of the column: faster than the threshold, and
/// sheared. Returns false when there is none.
bool lowest_motion(const ColumnIndex& index, std::span<const std::uint32_t> column,
                   double threshold, int& cell);
/// Finds the height down to which the column becomes active because soil moves in `cell` beside it.
/// Returns false when it stays.
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
