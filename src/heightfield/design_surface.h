// SPDX-License-Identifier: Apache-2.0
// The design surface on a site's columns, and how far the ground is from it.
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
  CellRect rect;         ///< holds every column that has a design
  std::vector<float> z;  ///< W [m] over `rect`, x fastest; NaN where there is none
  float at(int ix, int iy) const {
    return z[static_cast<std::size_t>(iy - rect.y0) * static_cast<std::size_t>(rect.x1 - rect.x0) +
             static_cast<std::size_t>(ix - rect.x0)];
  }
  /// Over a whole site of nx x ny columns, as maps want it.
  std::vector<float> over(int nx, int ny) const;
};

/// The design of `scene` on the columns of its site; nothing where it has none. Of `site` the
/// place, the georeference and the untouched heights are used.
///
/// A TIN is its triangles at the columns' centres; a raster is bilinear, at the edge of what it
/// knows the nearest cell; an area's sides end where they meet the untouched ground. Costs some 20
/// ns for a column and each edge of an area. A TIN's own unit is converted. A warning goes to the
/// log where only one of TIN and site has an EPSG code, and where one counts in international feet
/// and the other in those of US surveys.
/// @throws InputError naming file or line: a file that cannot be read, another CRS than the site's,
/// a surface that covers no column, an area that does not lie on the site.
std::optional<DesignSurface> make_design(const scene::Scene& scene, const Terrain& site);

/// The ground against its design, over the columns that have one. `cut` and `fill` are against the
/// untouched site, volumes as the soil lies.
struct DesignComparison {
  double area = 0;           ///< [m2]
  double design_cut = 0;     ///< untouched site above the design [m3]
  double design_fill = 0;    ///< below it [m3]
  double cut = 0, fill = 0;  ///< taken out and laid down so far [m3]
  double over_dig = 0;       ///< ground below the design [m3]
  double under_dig = 0;      ///< ground above it [m3]
  double mean_error = 0;     ///< ground minus design [m]
  double mean_size = 0;      ///< of its size [m]
  double largest_error = 0;  ///< that of the greatest size, with its sign [m]
};
DesignComparison against_design(const Terrain& ground, const DesignSurface& design);

}  // namespace navvy::heightfield
