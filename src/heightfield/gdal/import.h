// SPDX-License-Identifier: Apache-2.0
// Reads terrain maps (GeoTIFF, ESRI ASCII, PNG, NPY) as the surface of a site. Exists only in
// builds with NAVVY_WITH_GDAL.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/limits.h"
#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "heightfield/raster.h"
#include "heightfield/windowed_raster.h"
#include "scene/scene.h"

namespace navvy::heightfield {

/// Properties of a map file and of the site made from it. File coordinates are in the file's own
/// units, everything else is in metres.
struct TerrainReport {
  /// Path of the file, and the name of its format in GDAL.
  std::string file, format;
  /// Size of the whole file in cells.
  int columns = 0, rows = 0;
  /// Edges of a cell [m].
  double cell_x = 0, cell_y = 0;
  /// True when heights belong to points, so that the area of the file reaches half a cell beyond
  /// them.
  bool point_registered = false;
  /// Name of the CRS; empty where the file has none.
  std::string crs;
  /// Names of the units as the file gives them.
  std::string unit, height_unit;
  /// Metres per unit.
  double metres = 1, height_metres = 1;
  /// Extent of the map in file coordinates.
  Vec2 file_min = Vec2::Zero(), file_max = Vec2::Zero();
  /// Extent of the site in file coordinates.
  Vec2 site_min = Vec2::Zero(), site_max = Vec2::Zero();
  /// Map cells under the site and a margin of two.
  std::int64_t source_cells = 0;
  /// Gaps among those cells.
  GapFill nodata;
  /// Map cells at least partly on the site, and those of them without a height.
  std::int64_t site_cells = 0, site_gaps = 0;
  /// Nodata value as declared, or "none".
  std::string nodata_value;
  /// W z = file z - height_offset [m].
  double height_offset = 0;
  /// Range of the heights in the datum of the file [m].
  double lowest = 0, highest = 0;
  /// Slopes of the map under the site.
  SlopeRange slope;
  /// Angle of repose of the surface soil [rad].
  double repose = 0;
  /// Edge of a soil cell [m].
  double soil_cell = 0;
  /// Pitfalls found in the file, one sentence each.
  std::vector<std::string> notes;
  /// Cells whose number cannot be a height of ground and is not declared as nodata.
  std::int64_t unmarked = 0;
  /// First such number as it stands in the file.
  double unmarked_value = 0;
  /// True when the tools of GDAL can read the file, so that remedies may name them.
  bool for_gdal = true;

  /// Returns the report as some lines for people.
  std::string text() const;
  /// Returns one line about the heights that were filled in on the site: their share, the largest
  /// distance, and the remedy. Empty where the map has a height everywhere on the site.
  std::string warning() const;
  /// Returns the share of the site's map cells that were filled, 0 to 1.
  double share_filled() const;
  /// Returns the largest distance between a gap and a known height [m].
  double filled_from() const;
};

/// Reads the part of `world.ground.file` that the site covers and fills in the surface, datum and
/// georeference of `setup`, whose nx, ny, cell and origin are given. The map keeps its own
/// resolution and is interpolated on demand. Up to `held` cells of it are kept in memory; windows
/// of `side` cells are read from a larger one when columns are asked for. The heights are
/// bit-identical either way.
/// @throws InputError when the file is missing, unreadable, in degrees, rotated or without heights
/// here, or when the site is off the map.
TerrainReport import_terrain(const scene::Scene& world, Ground::Setup& setup,
                             double held = limits::kMapCells, int side = WindowedRaster::kSide);

}  // namespace navvy::heightfield
