// SPDX-License-Identifier: Apache-2.0
// Which columns must wake because of a tool (rule A) or because soil moves beside them (rule B).
// [docs/exchange.md, wake]
#pragma once

#include <map>
#include <span>
#include <vector>

#include "soil/exchange/exchange.h"
#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// A tool as columns see it. Rectangles lie inside the site and may be empty. It is made anew at
/// each check from the shell's box, so a tool that turned has another one. Cells are counted from
/// the datum, columns from the site's corner.
struct ToolZone {
  heightfield::CellRect box;   ///< columns under the tool's box
  heightfield::CellRect near;  ///< and those within kToolGuard of it
  heightfield::CellRect
      /// Columns to wake: two dig depths ahead, one to the sides, times the scene's awake zone.
      zone;
  double low = 0, high = 0;  ///< of the box [cells above datum]
  double scale = 1;          ///< the scene's awake zone
  double speed = 0;          ///< [m/s]
  int tool = -1;             ///< from add_tool
  bool supported = false;    ///< it stands: no soil wakes or stays awake because of it
  bool engaged = false;      ///< some column of the zone, with the soil on it, reaches up to it

  /// Under the box in plan; says nothing about heights.
  bool touches(int ix, int iy) const { return contains(box, ix, iy); }
  static bool contains(const heightfield::CellRect& r, int ix, int iy) {
    return ix >= r.x0 && ix < r.x1 && iy >= r.y0 && iy < r.y1;
  }
};

/// Height [cells above datum] each column shall wake down to. A column that is not in it stays. It
/// is ordered, as new particles come in its order.
using ActivationPlan = std::map<PlanKey, double>;

/// Where every tool is, its zone `scale` times as large as usual. Costs the columns of the zones.
/// In the order of `tools`; no rule depends on that order.
std::vector<ToolZone> tool_zones(const heightfield::Ground& ground, const ColumnIndex& index,
                                 std::span<const ToolRegion> tools, double scale);

/// Rule A: columns of the zone that reach within a cell (times the scale) of the tool's lowest
/// point wake to one or two cells below it. That a whole zone wakes, not what a tool touches alone,
/// is because soil fails ahead of a blade in a wedge as long as it digs deep or longer
/// [docs/exchange.md, wake].
void activate_ahead_of_tools(const heightfield::Ground& ground, std::span<const ToolZone> zones,
                             ActivationPlan& plan);

/// Speed above which soil counts as moving: 5 % of the slowest working tool's [m/s]. At least 0.05
/// m/s, also without a working tool: below, the elastic ringing of soil that has just woken would
/// wake the site.
double motion_threshold(std::span<const ToolZone> zones);

/// Rule B: a particle that has failed (plastic shear) and is faster than `threshold` wakes the 3 x
/// 3 columns around it that reach up to its cell. `may_activate` answers for a column whether this
/// rule applies to it now. In a working tool's zone it goes three cells below the tool and no
/// deeper. Costs the particles and nine columns for each column that moves.
template <class MayActivate>
void activate_around_motion(const heightfield::Ground& ground, const ColumnIndex& index,
                            double threshold, std::span<const ToolZone> zones,
                            const MayActivate& may_activate, ActivationPlan& plan);

/// Adds a request; of two for one column the deeper one stays.
void plan_activation(ActivationPlan& plan, int ix, int iy, double bottom);

// ---- implementation of the template

/// Lowest cell that holds a particle of the column that flows: faster than the threshold, and
/// sheared; false when there is none.
bool lowest_motion(const ColumnIndex& index, std::span<const std::uint32_t> column,
                   double threshold, int& cell);
/// Height the column must wake to because soil moves in `cell` next to it; false when it need not.
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
