// SPDX-License-Identifier: Apache-2.0
// The design surface of a site, sampled at its columns, and its comparison with the ground.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/terrain.h"
#include "scene/scene.h"

namespace navvy::heightfield {

/// Heights of the design surface at the column centres of a site. Immutable.
struct DesignSurface {
  /// Rectangle of site columns for which `z` holds values. It contains every column with a design
  /// height.
  CellRect rect;
  /// World z of the design surface at each column of `rect` [m], x fastest. NaN marks columns
  /// without a design height.
  std::vector<float> z;
  /// Returns the world z of the design surface in column (ix, iy) of the site [m]; NaN if it has
  /// none. The column must lie in `rect`.
  float at(int ix, int iy) const {
    return z[static_cast<std::size_t>(iy - rect.y0) * static_cast<std::size_t>(rect.x1 - rect.x0) +
             static_cast<std::size_t>(ix - rect.x0)];
  }
  /// Returns the design heights of all columns of a site of nx x ny columns [m], x fastest; NaN
  /// where there is no design height. This is the format of map::MapOptions::target.
  std::vector<float> over(int nx, int ny) const;
};

/// Computes the commanded design surface of `scene` (scene::Scene::commanded_design) at the columns
/// of `site`. Returns no value for a scene without one. Uses the position, the georeference and the
/// initial heights of `site`.
///
/// A TIN (triangulated surface) is sampled at the column centres, after conversion of its unit of
/// length. A raster is interpolated bilinearly and extended by its outermost cells. The side slopes
/// of a polygonal area end where they meet the initial ground. An area takes about 20 ns per column
/// and polygon edge.
///
/// Logs a warning if only one of TIN and site has an EPSG code, or if one uses international feet
/// and the other US survey feet.
/// @throws InputError naming file or line, for a file that cannot be read, a CRS other than that of
/// the site, a surface that covers no column, or an area that does not begin on the site.
std::optional<DesignSurface> make_design(const scene::Scene& scene, const Terrain& site);

/// Returns the surface of one pit or pad on the columns of `site`. Messages name `file` and the
/// line of the area. @throws InputError as `make_design`.
DesignSurface design_of_area(const scene::DesignArea& area, const Terrain& site,
                             const std::string& file);

/// Differences between the ground and its design surface, over all columns that have a design
/// height. Volumes are those of the soil in its current density state.
struct DesignComparison {
  /// Total area of the columns with a design height [m2].
  double area = 0;
  /// Volume between the initial ground and the design surface where the ground is higher than the
  /// design [m3].
  double design_cut = 0;
  /// Volume between the initial ground and the design surface where the ground is lower than the
  /// design [m3].
  double design_fill = 0;
  /// Volumes between the current and the initial ground: `cut` where the ground is now lower, and
  /// `fill` where it is higher [m3].
  double cut = 0, fill = 0;
  /// Volume between the current ground and the design surface where the ground is lower than the
  /// design [m3].
  double over_dig = 0;
  /// Volume between the current ground and the design surface where the ground is higher than the
  /// design [m3].
  double under_dig = 0;
  /// Ground height minus design height, averaged over all columns with a design height [m].
  double mean_error = 0;
  /// Absolute value of ground height minus design height, averaged over all columns with a design
  /// height [m].
  double mean_size = 0;
  /// Ground height minus design height in the column where the two differ most [m]; positive if the
  /// ground is higher.
  double largest_error = 0;
};
/// Compares the current heights of `ground` with `design`. All results are 0 if no column has a
/// design height.
DesignComparison against_design(const Terrain& ground, const DesignSurface& design);

}  // namespace navvy::heightfield
