// SPDX-License-Identifier: Apache-2.0
// The surface of a site, for everything that reads it: wheels, pictures, maps, exports, operators,
// planners.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/math.h"
#include "heightfield/cell_rect.h"
#include "heightfield/ground_setup.h"
#include "heightfield/surface_table.h"

namespace navvy::heightfield {

/// Selects the surface that a view of the terrain shows.
enum class SurfaceKind : std::uint8_t {
  /// Resting soil only: the tops of the columns.
  kColumns,
  /// Resting soil and the particles above it, as a camera or a lidar sees them. Includes soil in a
  /// bucket near the ground.
  kWithLooseSoil,
  /// Resting soil and the loose soil on it, without soil in buckets and truck beds. Used for maps,
  /// exported files and volumes.
  kMapped
};

/// Read-only interface to the surface of a site. A `Ground` provides its current state, and a
/// `TerrainView` a copy that never changes.
///
/// Several threads may read at the same time; a live ground must not change meanwhile. Columns are
/// numbered as in GroundSetup. Once a column was read, its height takes 8 ns at the column centre
/// and 19 ns between centres, whether or not the column was changed.
class Terrain {
 public:
  /// Returns the description of the site: grid, soils and georeference.
  const GroundSetup& setup() const { return *setup_; }
  /// Returns the number of columns along x.
  int nx() const { return setup_->nx; }
  /// Returns the number of columns along y.
  int ny() const { return setup_->ny; }
  /// Returns the edge length of a column [m].
  double cell() const { return setup_->cell; }
  /// Returns the world (x, y) of the corner of the site with the smallest x and y [m].
  const Vec2& origin() const { return setup_->origin; }
  /// Returns the world z of bedrock [m].
  double datum() const { return setup_->datum; }
  /// Returns the rectangle of all columns of the site.
  CellRect site_rect() const { return {0, 0, nx(), ny()}; }
  /// Returns true if the site has a column (ix, iy).
  bool contains(int ix, int iy) const { return ix >= 0 && iy >= 0 && ix < nx() && iy < ny(); }
  /// Returns the indices of the column that contains world position (x, y) [m]. They may lie
  /// outside the site.
  Vec2i column_at(double x, double y) const;

  /// Returns the height of the surface in column (ix, iy), as world z [m]. Indices outside the site
  /// give the value of the nearest column inside it.
  double height(int ix, int iy) const {
    ix = std::clamp(ix, 0, setup_->nx - 1);
    iy = std::clamp(iy, 0, setup_->ny - 1);
    const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
    return tile != nullptr ? tile->height[static_cast<std::size_t>(index_in_tile(ix, iy))]
                           : start_->height(ix, iy);
  }
  /// Returns the initial height of the ground in column (ix, iy), as world z [m]. Indices outside
  /// the site give the value of the nearest column inside it.
  double start_height(int ix, int iy) const;
  /// Returns the uppermost soil of column (ix, iy), as an index into setup().soils. Indices outside
  /// the site give the value of the nearest column inside it.
  std::uint16_t surface_soil(int ix, int iy) const;
  /// Returns the density state of the uppermost soil in column (ix, iy), which is its volume
  /// divided by its bank volume [-]; 1 for undisturbed ground. Indices outside the site give the
  /// value of the nearest column inside it.
  float specific_volume(int ix, int iy) const;
  /// Returns the depth of the loose soil on column (ix, iy) [m]; always 0 in a live ground and in
  /// views of kind SurfaceKind::kColumns. Indices outside the site give the value of the nearest
  /// column inside it.
  float loose_depth(int ix, int iy) const;
  /// Returns true if the visible soil of column (ix, iy) consists of particles, which may still
  /// move.
  bool active(int ix, int iy) const { return loose_depth(ix, iy) > 0; }

  /// Returns the height of the surface at world position (x, y) [m], as world z [m]. The surface is
  /// bilinear between column centres, and level beyond the outermost centres.
  double sample(double x, double y) const;
  /// Returns the unit upward normal, in world axes, of the bilinear surface at world position (x,
  /// y) [m].
  Vec3 normal(double x, double y) const;
  /// Intersects the surface with the ray from `p` in the direction of the unit vector `d`, both in
  /// world coordinates, up to the distance `range` [m]. Returns the distance from `p` to the first
  /// hit [m], 0 if `p` is below the surface, and a negative value if nothing is hit or a coordinate
  /// is not finite.
  double ray(const Vec3& p, const Vec3& d, double range) const;

  /// Writes the surface heights of the columns in `rect` to `out`, as world z [m], x fastest.
  /// Columns outside the site get the height of the nearest column inside it. (For other quantities
  /// see map::MapMaker.)
  void copy_heights(const CellRect& rect, std::vector<float>& out) const;

  /// Returns the maximum surface height in `rect`, as world z [m]; minus infinity if the rectangle
  /// is empty. Takes about 1 ns per column.
  double highest(const CellRect& rect) const;

  /// Returns a number that increases with every change of the ground. A ground has the same columns
  /// whenever it has the same number.
  std::uint64_t sequence() const { return sequence_; }

 protected:
  /// Makes a terrain that shows the untouched site with the initial heights `start`.
  explicit Terrain(std::shared_ptr<const StartHeights> start);
  /// Copies the surface. Copying and moving are protected, because only derived classes are
  /// complete objects.
  Terrain(const Terrain&) = default;
  Terrain(Terrain&&) noexcept = default;
  Terrain& operator=(const Terrain&) = default;
  Terrain& operator=(Terrain&&) noexcept = default;
  ~Terrain() = default;

  /// Initial heights, shared by a ground and its views.
  std::shared_ptr<const StartHeights> start_;
  /// Description of the site. Points into `start_`, so it remains valid when this object is moved.
  const GroundSetup* setup_;
  /// Surface of the tiles that differ from the untouched site.
  SurfaceTable table_;
  /// Number that increases with every change of the ground.
  std::uint64_t sequence_ = 0;

 private:
  friend class ChangeFollower;
  /// Writes the heights of columns (ix, iy), (ix + 1, iy), (ix, iy + 1) and (ix + 1, iy + 1) to
  /// z[0] to z[3]. They are the corners of one dual cell, in which the surface is bilinear.
  void corners(int ix, int iy, double z[4]) const;
  /// Finds the dual cell, which is the square between four column centres, that contains world
  /// position (x, y) [m]. Returns the column at its first corner in (ix, iy), and the position
  /// within the cell in (u, v), from 0 to 1.
  void locate(double x, double y, int& ix, int& iy, double& u, double& v) const;
};

}  // namespace navvy::heightfield
