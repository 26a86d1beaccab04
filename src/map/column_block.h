// SPDX-License-Identifier: Apache-2.0
// Inputs from which map layers are computed: the state of every column of a site at one instant.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "heightfield/terrain_view.h"
#include "map/derived_layers.h"
#include "map/map_layers.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Layers that a map contains, and the parameters to compute them.
struct MapOptions {
  /// Layers of the map. Layers that these are computed from are added automatically.
  std::vector<MapLayer> layers = default_layers();
  /// Limits for the layer kTraversability, and the window size for kStepHeight and kRoughness.
  TraversabilityLimits limits;
  /// World z of the design surface [m], one value per column of the site, x fastest; NaN for
  /// columns without a design height. Empty if the site has no design.
  std::vector<float> target;
  /// False leaves machines out of the layers kOccupied and kTraversability, which then show only
  /// bodies without joints, wheels and program.
  bool machines = true;
};

/// Bodies that are higher above the surface than this do not occupy it [m]: the clearance of a
/// bridge over a track for construction vehicles, typical but unverified (U).
inline constexpr double kHeadroom = 4;

/// Height of bodies above the surface [m], by the index of the column, y x width + x. Columns
/// without a body have no entry.
using OccupiedColumns = std::unordered_map<std::int64_t, float>;
/// Returns the columns of `view` that its bodies occupy. A column counts if any part of it is under
/// a body.
OccupiedColumns occupied_columns(const heightfield::TerrainView& view, const MapOptions& options);

/// State of all columns of a site at one instant, taken from a terrain view. Immutable, so any
/// number of threads may read it. A derived class represents a site about which less is known, such
/// as one read from a file.
class SiteColumns {
 public:
  /// Describes the columns as they are in `view`, for maps with the given options.
  SiteColumns(heightfield::TerrainView view, std::shared_ptr<const MapOptions> options);
  /// Allows deletion through a base class pointer.
  virtual ~SiteColumns() = default;

  /// Returns the terrain view from which heights and soil properties are read.
  const heightfield::TerrainView& view() const { return view_; }
  /// Returns the options of the map.
  const MapOptions& options() const { return *options_; }
  /// Returns true if this object provides the data `needs`. Layers that need other data are unknown
  /// in every column.
  virtual bool knows(LayerNeeds needs) const;

  /// Returns the height of the surface in site column (ix, iy), as world z [m]. The indices are not
  /// checked.
  double height(int ix, int iy) const { return view_.height(ix, iy); }
  /// Returns the initial height of the ground in site column (ix, iy), as world z [m]. The indices
  /// are not checked.
  virtual double start_height(int ix, int iy) const { return view_.start_height(ix, iy); }
  /// Returns the height of the design surface in site column (ix, iy), as world z [m]; NaN if there
  /// is none. The indices are not checked.
  float target(int ix, int iy) const;
  /// Returns the depth of loose soil, which consists of particles, on site column (ix, iy) [m]. The
  /// indices are not checked.
  virtual float loose_depth(int ix, int iy) const { return view_.loose_depth(ix, iy); }
  /// Returns the uppermost soil of site column (ix, iy), as an index into the setup's list of
  /// soils. The indices are not checked.
  float soil(int ix, int iy) const { return view_.surface_soil(ix, iy); }
  /// Returns volume divided by bank volume of the uppermost soil in site column (ix, iy) [-]. The
  /// indices are not checked.
  float specific_volume(int ix, int iy) const { return view_.specific_volume(ix, iy); }
  /// Returns the height of a body's top above the surface in site column (ix, iy) [m]; 0 without a
  /// body. The indices are not checked.
  float occupied(int ix, int iy) const;
  /// Returns all columns that bodies occupy.
  const OccupiedColumns& occupied() const { return occupied_; }
  /// Returns the bulk density of the uppermost soil in site column (ix, iy) [kg/m3]. The indices
  /// are not checked.
  float density(int ix, int iy) const;

 private:
  /// Terrain view from which heights and soil properties are read.
  heightfield::TerrainView view_;
  /// Options of the map; never null.
  std::shared_ptr<const MapOptions> options_;
  /// Columns that bodies occupy.
  OccupiedColumns occupied_;
};

/// A rectangle of columns for which a layer is computed. The heights of the whole rectangle are
/// copied when the first one is requested, which is faster than one look-up per column. Only one
/// thread may use a block.
class ColumnBlock {
 public:
  /// Represents the columns of `site` in `rect`. Both arguments must outlive the block.
  ColumnBlock(const SiteColumns& site, const heightfield::CellRect& rect)
      : site_(site), rect_(rect) {}

  /// Returns the state of the site.
  const SiteColumns& site() const { return site_; }
  /// Returns the height of the surface in column (ix, iy), as world z [m]. The column must lie in
  /// the rectangle.
  float elevation(int ix, int iy) const;

 private:
  /// State of the site.
  const SiteColumns& site_;
  /// Rectangle of columns for which a layer is computed.
  const heightfield::CellRect& rect_;
  /// Heights of the rectangle as world z [m], x fastest; empty until one is requested.
  mutable std::vector<float> z_;
};

/// Returns a map with sequence number `sequence` and the layers of site->options(). The values are
/// computed from `site` when they are read.
/// @throws InputError if the options contain a target whose size is not the number of columns, or
/// limits that are not finite and positive.
TerrainMap make_map(const std::shared_ptr<const SiteColumns>& site, std::uint64_t sequence);

}  // namespace navvy::map
