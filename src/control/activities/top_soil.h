// SPDX-License-Identifier: Apache-2.0
// Height and density of the uppermost soil in a polygon. Private to compact.
#pragma once

#include <vector>

#include "control/outcome.h"
#include "core/archive.h"
#include "core/math.h"
#include "heightfield/layered_ground.h"

namespace navvy::control {

/// Mean height of the ground in a polygon, and mean density of its uppermost 0.3 m. Active soil
/// does not count.
struct TopSoil {
  /// Height in W [m].
  double height = 0;
  /// Density [kg/m3]; bare rock counts as 0.
  double density = 0;

  /// Saves or loads both values.
  void visit(Archive& a) {
    a("height", height);
    a("density", density);
  }
};

/// Returns the uppermost soil of the columns whose centres are in `polygon`. Both values are 0 if
/// there is no such column.
TopSoil top_soil_in(const std::vector<Vec2>& polygon, const heightfield::Ground& site);

/// Appends the densities before and now, and how far the ground has sunk, to the account of a step.
void add_settlement(const TopSoil& before, const TopSoil& now, std::vector<Measurement>& account);

}  // namespace navvy::control
