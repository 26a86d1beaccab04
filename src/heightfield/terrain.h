// SPDX-License-Identifier: Apache-2.0
// The surface of a site for all its readers: wheels, pictures, maps, exports, operators, planners.
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

/// Surface that a reader asks for. Every client names it where it takes its view.
enum class SurfaceKind : std::uint8_t {
  /// The resting columns alone.
  kColumns,
  /// The columns and the particles on them: what an eye or a lidar sees, including soil in a bucket
  /// near the ground.
  kWithLooseSoil,
  /// The columns and the particles on them, without the contents of buckets and beds: what maps,
  /// files and volumes count.
  kMapped
};

/// The read-only side of a ground. `Ground` implements it with the columns of the present moment,
/// `TerrainView` as a copy that never changes.
///
/// Columns are numbered as in GroundSetup. Reading has no visible effect and may be done by several
/// threads at a time; a live ground must not change meanwhile. A height costs 8 ns at a column and
/// 19 ns between columns, dug or not, where the columns have been read before.
class Terrain {
 public:
  /// Returns the grid, the soils and the georeference of the site.
  const GroundSetup& setup() const { return *setup_; }
  /// Returns the number of columns along x and y.
  int nx() const { return setup_->nx; }
  int ny() const { return setup_->ny; }
  /// Returns the edge of a column [m].
  double cell() const { return setup_->cell; }
  /// Returns the lower-left corner of the site in W [m].
  const Vec2& origin() const { return setup_->origin; }
  /// Returns the height of bedrock in W [m].
  double datum() const { return setup_->datum; }
  /// Returns the rectangle of all columns.
  CellRect site_rect() const { return {0, 0, nx(), ny()}; }
  /// Returns true when the site has column (ix, iy).
  bool contains(int ix, int iy) const { return ix >= 0 && iy >= 0 && ix < nx() && iy < ny(); }
  /// Returns the column that holds W (x, y); it may lie outside the site.
  Vec2i column_at(double x, double y) const;

  /// Returns the height of the surface in W [m]. Here and below, a column outside the site stands
  /// for the nearest one inside.
  double height(int ix, int iy) const {
    ix = std::clamp(ix, 0, setup_->nx - 1);
    iy = std::clamp(iy, 0, setup_->ny - 1);
    const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
    return tile != nullptr ? tile->height[static_cast<std::size_t>(index_in_tile(ix, iy))]
                           : start_->height(ix, iy);
  }
  /// Returns the height of the untouched site in W [m].
  double start_height(int ix, int iy) const;
  /// Returns the soil at the surface, an index into setup().soils.
  std::uint16_t surface_soil(int ix, int iy) const;
  /// Returns the density state at the surface: volume over bank volume of the uppermost layer, 1
  /// where no one worked [-].
  float specific_volume(int ix, int iy) const;
  /// Returns the depth of the loose soil on the column [m]; 0 in every terrain of columns alone.
  float loose_depth(int ix, int iy) const;
  /// Returns true where the visible soil consists of particles, which may still move.
  bool active(int ix, int iy) const { return loose_depth(ix, iy) > 0; }

  /// Returns the height at W (x, y) [m]: bilinear between the centres of columns, level beyond the
  /// outermost ones.
  double sample(double x, double y) const;
  /// Returns the unit upward normal in W of the same surface.
  Vec3 normal(double x, double y) const;
  /// Returns the distance of the first hit of the ray p + t d, 0 <= t <= range (d unit, W) [m];
  /// negative when there is none, 0 when p is in the soil.
  double ray(const Vec3& p, const Vec3& d, double range) const;

  /// Copies the heights of a rectangle, which may reach beyond the site, x fastest [m]. Other
  /// layers: src/map.
  void copy_heights(const CellRect& rect, std::vector<float>& out) const;

  /// Returns the greatest height in a rectangle in W [m]; minus infinity for an empty one. Costs
  /// about a nanosecond per column.
  double highest(const CellRect& rect) const;

  /// Returns a number that grows with every change of the ground; equal numbers of one ground mean
  /// equal columns.
  std::uint64_t sequence() const { return sequence_; }

 protected:
  /// Makes an untouched site.
  explicit Terrain(std::shared_ptr<const StartHeights> start);
  // Only derived classes copy and move: half a ground is useless.
  Terrain(const Terrain&) = default;
  Terrain(Terrain&&) noexcept = default;
  Terrain& operator=(const Terrain&) = default;
  Terrain& operator=(Terrain&&) noexcept = default;
  ~Terrain() = default;

  // A ground and its views share the untouched site and all tiles that did not change in between.
  std::shared_ptr<const StartHeights> start_;
  // Stored in the site, so it stays valid when this object is moved.
  const GroundSetup* setup_;
  SurfaceTable table_;
  std::uint64_t sequence_ = 0;

 private:
  friend class ChangeFollower;
  /// Reads the heights of the four corners of a dual cell.
  void corners(int ix, int iy, double z[4]) const;
  /// Finds the dual cell around a place and the position in it.
  void locate(double x, double y, int& ix, int& iy, double& u, double& v) const;
};

}  // namespace navvy::heightfield
