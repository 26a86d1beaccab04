// SPDX-License-Identifier: Apache-2.0
// Volumes and shapes of a score. Private to the score.
#pragma once

#include "heightfield/design_surface.h"
#include "heightfield/terrain_view.h"
#include "record/score.h"

namespace navvy::record {

/// Returns true if column (ix, iy) has a design height.
bool has_design(const heightfield::DesignSurface& design, int ix, int iy);
/// Adds the volumes between `surface` and its start in `rect` to `inside` for columns with a design
/// height, and to `outside` for all others. `design` may be null.
void add_volumes(const heightfield::Terrain& surface, const heightfield::CellRect& rect,
                 const heightfield::DesignSurface* design, AreaScore& inside, AreaScore& outside);
/// Returns the comparison of `surface` with `design`.
ShapeScore measure_shape(const heightfield::Terrain& surface,
                         const heightfield::DesignSurface& design);

}  // namespace navvy::record
