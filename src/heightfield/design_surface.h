// SPDX-License-Identifier: Apache-2.0
// The design surface on the columns of a site, and the distance of the ground from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/terrain.h"
#include "scene/scene.h"

namespace navvy::heightfield {

/// Design heights at the centres of columns. Immutable.
struct DesignSurface {
  /// Rectangle that holds every column with a design.
  CellRect rect;
  /// Heights in W [m] over `rect`, x fastest; NaN where there is no design.
  std::vector<float> z;
  /// Returns the design height of column (ix, iy), which must lie in `rect` [m].
  float at(int ix, int iy) const {
    return z[static_cast<std::size_t>(iy - rect.y0) * static_cast<std::size_t>(rect.x1 - rect.x0) +
             static_cast<std::size_t>(ix - rect.x0)];
  }
  /// Returns the heights over a whole site of nx x ny columns [m], x fastest, as map::MapOptions
  /// takes them.
  std::vector<float> over(int nx, int ny) const;
};

/// Computes the design of `scene` on the columns of its site; returns nothing for a scene without a
/// design. Uses the place, the georeference and the untouched heights of `site`.
///
/// A TIN is sampled at the centres of the columns. A raster is interpolated bilinearly; beyond its
/// outermost cells the nearest one counts. The sides of an area end where they meet the untouched
/// ground. The unit of a TIN is converted. Costs some 20 ns per column and edge of an area. Logs a
/// warning where only one of TIN and site has an EPSG code, and where one uses international feet
/// and the other US survey feet.
/// @throws InputError naming file or line for a file that cannot be read, a CRS other than the
/// site's, a surface that covers no column, or an area that does not lie on the site.
std::optional<DesignSurface> make_design(const scene::Scene& scene, const Terrain& site);

/// Comparison of the ground with its design, over the columns that have one. `cut` and `fill` count
/// against the untouched site, in the present volume of the soil.
struct DesignComparison {
  /// Area of the columns [m2].
  double area = 0;
  /// Volume of the untouched site above the design [m3].
  double design_cut = 0;
  /// Volume of the untouched site below the design [m3].
  double design_fill = 0;
  /// Volumes removed and placed so far [m3].
  double cut = 0, fill = 0;
  /// Volume by which the ground lies below the design [m3].
  double over_dig = 0;
  /// Volume by which the ground lies above the design [m3].
  double under_dig = 0;
  /// Mean of ground minus design [m].
  double mean_error = 0;
  /// Mean of |ground minus design| [m].
  double mean_size = 0;
  /// Ground minus design where its absolute value is largest, with its sign [m].
  double largest_error = 0;
};
/// Compares the present ground with its design.
DesignComparison against_design(const Terrain& ground, const DesignSurface& design);

}  // namespace navvy::heightfield
