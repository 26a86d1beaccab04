// SPDX-License-Identifier: Apache-2.0
// The surface of a site as everybody reads it: wheels, pictures, maps, exports, operators,
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

/// Which surface a reader asks for. Every client names it where it takes its view, so that it
/// changes its mind in one place.
enum class SurfaceKind : std::uint8_t {
  kColumns,  ///< the resting columns alone
  /// And what lies on them as particles: what an eye or a lidar sees, also in a bucket near the.
  kWithLooseSoil,
  ///< ground
  /// And what lies on them, less what buckets and beds hold: what maps, files and volumes count.
  kMapped
};

/// The readable side of a ground, the same for both kinds there are: `Ground`, whose columns are
/// those of this very moment, and `TerrainView`, a copy that never changes.
///
/// Columns are numbered as in GroundSetup. Reading changes nothing that can be seen and may be done
/// from several threads at a time; a live ground must not be changed meanwhile. A height costs 8 ns
/// at a column and 19 ns between columns, dug or not, where the columns have been read before.
class Terrain {
 public:
  const GroundSetup& setup() const { return *setup_; }
  int nx() const { return setup_->nx; }
  int ny() const { return setup_->ny; }
  double cell() const { return setup_->cell; }
  const Vec2& origin() const { return setup_->origin; }
  double datum() const { return setup_->datum; }
  CellRect site_rect() const { return {0, 0, nx(), ny()}; }
  bool contains(int ix, int iy) const { return ix >= 0 && iy >= 0 && ix < nx() && iy < ny(); }
  /// Column that holds W (x, y); may lie outside the site.
  Vec2i column_at(double x, double y) const;

  // Of column (ix, iy); outside the site of the nearest one.
  /// Height of the surface in W [m].
  double height(int ix, int iy) const {
    ix = std::clamp(ix, 0, setup_->nx - 1);
    iy = std::clamp(iy, 0, setup_->ny - 1);
    const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
    return tile != nullptr ? tile->height[static_cast<std::size_t>(index_in_tile(ix, iy))]
                           : start_->height(ix, iy);
  }
  /// Height of the untouched site in W [m].
  double start_height(int ix, int iy) const;
  /// Soil at the surface, an index into setup().soils.
  std::uint16_t surface_soil(int ix, int iy) const;
  /// Density state at the surface: volume / bank volume of the uppermost layer, 1 where nobody
  /// worked [-].
  float specific_volume(int ix, int iy) const;
  /// Depth of the loose soil that lies on the column [m]; 0 in every terrain of columns alone.
  float loose_depth(int ix, int iy) const;
  /// Whether what one sees there are particles, which may still move, and not a resting column.
  bool active(int ix, int iy) const { return loose_depth(ix, iy) > 0; }

  // Between column centres, bilinear; beyond the outermost centres level.
  /// Height at W (x, y) [m].
  double sample(double x, double y) const;
  /// Unit upward normal in W.
  Vec3 normal(double x, double y) const;
  /// First hit of the ray p + t d, 0 <= t <= range (d unit, W); negative when there is none, 0 when
  /// p is in the soil [m].
  double ray(const Vec3& p, const Vec3& d, double range) const;

  /// Dense copy of heights of a rectangle, which may reach beyond the site, x fastest [m]. Other
  /// layers are those of src/map.
  void copy_heights(const CellRect& rect, std::vector<float>& out) const;

  /// Highest of the columns of a rectangle, of which those outside the site are the nearest in it
  /// [m]; minus infinity of an empty one. About a nanosecond a column.
  double highest(const CellRect& rect) const;

  /// Grows with every change of the ground; equal numbers of one ground mean equal columns.
  std::uint64_t sequence() const { return sequence_; }

 protected:
  explicit Terrain(std::shared_ptr<const StartHeights> start);
  /// The untouched site.
  // Copied and moved by what derives from it only: half a ground is of no use.
  Terrain(const Terrain&) = default;
  Terrain(Terrain&&) noexcept = default;
  Terrain& operator=(const Terrain&) = default;
  Terrain& operator=(Terrain&&) noexcept = default;
  ~Terrain() = default;

  // A ground and its views share the untouched site and all tiles that did not change in between.
  std::shared_ptr<const StartHeights> start_;
  // In the site, wherever this object is moved.
  const GroundSetup* setup_;
  SurfaceTable table_;
  std::uint64_t sequence_ = 0;

 private:
  friend class ChangeFollower;
  void corners(int ix, int iy, double z[4]) const;
  void locate(double x, double y, int& ix, int& iy, double& u, double& v) const;
};

}  // namespace navvy::heightfield
