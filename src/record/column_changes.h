// SPDX-License-Identifier: Apache-2.0
// Columns whose soil differs from that at the start, with the active soil that rests on them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/layered_ground.h"
#include "heightfield/loose_soil.h"
#include "sim/world.h"

namespace navvy::record {

/// Returns the rectangle of all columns that may differ from their start, cut to the site.
/// `on_ground` is the active soil that rests on columns.
heightfield::CellRect changed_rect(const heightfield::Ground& ground,
                                   const heightfield::LooseSoil& on_ground);

/// Difference of one column from its start.
struct ColumnChange {
  /// Indices of the column.
  int ix = 0, iy = 0;
  /// Mass of each soil of the scene now, with the active soil on the column, minus that at the
  /// start [kMassQuantum].
  std::vector<std::int64_t> gain;
};

/// Calls `use` for each column that may differ from its start, row by row. `on_ground` is the
/// active soil that rests on columns (ActivePlaces::on_ground of sim::active_places). All other
/// columns hold what they held at the start, so the sums over the calls are those over the site.
/// Costs a pass over the touched part of the site.
void for_each_changed_column(const sim::World& world, const heightfield::LooseSoil& on_ground,
                             const std::function<void(const ColumnChange&)>& use);

}  // namespace navvy::record
