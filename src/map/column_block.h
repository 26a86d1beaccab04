// SPDX-License-Identifier: Apache-2.0
// What map layers are computed from: the state of every column of a site at one instant.
#pragma once

#include <memory>
#include <vector>

#include "heightfield/terrain_view.h"
#include "map/derived_layers.h"
#include "map/map_layers.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Options of a map: its contents.
struct MapOptions {
  /// Layers of the map; the layers that these are computed from are added.
  std::vector<MapLayer> layers = default_layers();
  /// Limits for kTraversability and the window of step height and roughness.
  TraversabilityLimits limits;
  /// Design surface in W [m], one value per column, x fastest, NaN where there is none. Empty means
  /// that the site has no design.
  std::vector<float> target;
};

/// State of the columns of a site at one instant, as a terrain view holds it. Immutable, so any
/// number of threads may read. A source that knows less than a view overrides the functions.
class SiteColumns {
 public:
  /// Describes the site as `view` shows it.
  SiteColumns(heightfield::TerrainView view, std::shared_ptr<const MapOptions> options);
  virtual ~SiteColumns() = default;

  /// Returns the view of the site.
  const heightfield::TerrainView& view() const { return view_; }
  /// Returns the options of the map.
  const MapOptions& options() const { return *options_; }
  /// Returns false where layers with these needs are unknown in every column.
  virtual bool knows(LayerNeeds needs) const;

  // Every function below takes a column of the site; nothing is checked.
  /// Height of the surface in W [m].
  double height(int ix, int iy) const { return view_.height(ix, iy); }
  /// Height of the untouched site in W [m].
  virtual double start_height(int ix, int iy) const { return view_.start_height(ix, iy); }
  /// Height of the design surface in W [m]; unknown without a design.
  float target(int ix, int iy) const;
  /// Depth of the soil that rests on the column as particles [m].
  virtual float loose_depth(int ix, int iy) const { return view_.loose_depth(ix, iy); }
  /// Index of the uppermost soil in setup().soils.
  float soil(int ix, int iy) const { return view_.surface_soil(ix, iy); }
  /// Volume over bank volume of the uppermost soil.
  float specific_volume(int ix, int iy) const { return view_.specific_volume(ix, iy); }
  /// Bulk density of the uppermost soil [kg/m3].
  float density(int ix, int iy) const;

 private:
  heightfield::TerrainView view_;
  std::shared_ptr<const MapOptions> options_;
};

/// A rectangle of columns for which a layer is computed. Copies the heights of the rectangle when
/// the first elevation is asked for, which is faster than one look-up per column. One thread.
class ColumnBlock {
 public:
  /// Both must outlive the block.
  ColumnBlock(const SiteColumns& site, const heightfield::CellRect& rect)
      : site_(site), rect_(rect) {}

  /// Returns the state of the site.
  const SiteColumns& site() const { return site_; }
  /// Returns the height of the surface of a column of the rectangle in W [m].
  float elevation(int ix, int iy) const;

 private:
  const SiteColumns& site_;
  const heightfield::CellRect& rect_;
  mutable std::vector<float> z_;
};

/// Makes the map of a site whose columns are computed when a reader asks for them. The map has
/// sequence number `sequence` and the layers of the options.
/// @throws InputError for a target with another number of values than the site has columns, and for
/// limits that are not finite and positive.
TerrainMap make_map(const std::shared_ptr<const SiteColumns>& site, std::uint64_t sequence);

}  // namespace navvy::map
