// SPDX-License-Identifier: Apache-2.0
// The resting ground: columns of layered soil over a bedrock datum, counted in integer mass.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/hash.h"
#include "core/math.h"
#include "core/state_io.h"
#include "scene/ground.h"
#include "scene/soil.h"

namespace navvy::heightfield {

/// One soil layer of a column. Its thickness is mass x specific_volume / (bank_density x cell^2).
struct Layer {
  std::uint16_t soil = 0;     ///< index into the scene's soils
  std::int64_t mass = 0;      ///< in kMassQuantum
  float specific_volume = 1;  ///< volume / bank volume: 1 = bank, up to the soil's swell
  float plastic_shear = 0;    ///< accumulated, for remoulded cohesion [-]
};

/// A rectangle of columns, half open.
struct CellRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  void include(int ix, int iy);
  void include(const CellRect& other);
};

/// Where the untouched surface comes from: height [m] of the bank surface in W at a column centre, any (ix, iy) of the
/// site. Must be a pure function: tiles are made from it when first touched.
using SurfaceSource = std::function<double(int ix, int iy)>;

/// Columns of layered soil on a regular grid.
///
/// Only 32 x 32 tiles that were touched hold columns; the others are computed from the source on reading, so memory and
/// time follow touched tiles, never the site. Column (0,0) has least x and least y, x runs fastest, centre of column
/// (ix, iy) at origin + ((ix, iy) + 0.5) cell. Every change is mass-exact and announced by a sequence number and a
/// rectangle. Not thread-safe.
class Ground {
 public:
  struct Setup {
    int nx = 0, ny = 0;
    double cell = 0.1;           ///< [m]
    Vec2 origin = Vec2::Zero();  ///< W of the site's lower-left corner [m]
    double datum = 0;            ///< W height of bedrock, where every column starts [m]
    std::vector<scene::Soil> soils;
    std::vector<scene::GroundLayer> layers;  ///< from the surface down
    std::vector<scene::GroundPatch> patches;
    SurfaceSource surface;
    // Georeference of the site, for exports: file coordinates of `origin`, and its CRS as WKT (empty: none).
    // File z [m] = W z + height_offset; the file may count in feet.
    double easting = 0, northing = 0, height_offset = 0;
    double file_unit = 1, file_height_unit = 1;  ///< metres per unit of the file's coordinates and heights
    std::string crs_wkt;
  };
  explicit Ground(Setup setup);
  ~Ground();
  Ground(Ground&&) noexcept;
  Ground& operator=(Ground&&) noexcept;

  int nx() const;
  int ny() const;
  double cell() const;
  const Vec2& origin() const;
  double datum() const;
  const Setup& setup() const;
  bool contains(int ix, int iy) const { return ix >= 0 && iy >= 0 && ix < nx() && iy < ny(); }
  /// Column that holds W (x, y); may lie outside the site.
  Vec2i column_at(double x, double y) const;

  /// Surface height in W [m]; outside the site the nearest column's.
  double height(int ix, int iy) const;
  double start_height(int ix, int iy) const;  ///< of the untouched site
  /// Bilinear between column centres [m].
  double sample(double x, double y) const;
  /// Unit upward normal of the bilinear surface.
  Vec3 normal(double x, double y) const;
  /// First hit of the ray p + t d, 0 <= t <= range (d unit); negative when there is none, 0 when p is in the soil [m].
  double ray(const Vec3& p, const Vec3& d, double range) const;

  /// Layers of a column, bottom first (a copy; for untouched columns computed from the source).
  std::vector<Layer> layers(int ix, int iy) const;
  /// Same into a vector that the caller keeps, without allocating in loops.
  void column(int ix, int iy, std::vector<Layer>& out) const;
  /// Same as of the untouched site.
  void start_column(int ix, int iy, std::vector<Layer>& out) const;
  /// Soil index at the surface.
  std::uint16_t surface_soil(int ix, int iy) const;
  /// Volume / bank volume of the surface's layer [-]; 1 of untouched ground.
  double surface_volume_ratio(int ix, int iy) const;
  /// Takes off everything above W height z [m] and appends it to `taken`, bottom first; the masses are exact. Leaves
  /// the column's surface at z up to one mass quantum.
  void take_above(int ix, int iy, double z, std::vector<Layer>& taken);
  /// Puts a layer on top; merges with the top layer when soil and density state match (within 1e-3), volumes added.
  void put(int ix, int iy, const Layer& layer);
  /// Presses the surface down to `height` by raising density (ruts): mass stays, the top layers' specific volume falls,
  /// not below `min_specific_volume`.
  void compact_to(int ix, int iy, double height, float min_specific_volume = 0.85f);

  /// Sum over the touched tiles of mass now minus mass at the start, per soil, recounted from the columns.
  std::vector<std::int64_t> mass_change() const;
  /// Sum over the touched tiles of (height now - height at start) x cell^2, positive part and negative part [m3].
  void volume_change(double& raised, double& lowered) const;

  /// Grows with every change. `changed_since(n)` is the rectangle changed after sequence n (exact for recent n, a
  /// bounding superset for older ones).
  std::uint64_t sequence() const;
  CellRect changed_since(std::uint64_t sequence) const;

  /// Bounding rectangle of all touched tiles; every column that ever changed lies in it.
  CellRect touched_rect() const;

  /// Dense copy of heights of a rectangle, x fastest [m].
  void copy_heights(const CellRect& rect, std::vector<float>& out) const;

  std::size_t touched_tiles() const;
  /// Changed columns in the order of their tiles. Loading does not announce changes: who mirrors the ground reads it
  /// anew after a load.
  void hash(StateHash& hash) const;
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::heightfield
