// SPDX-License-Identifier: Apache-2.0
// Terrain maps (GeoTIFF, ESRI ASCII, PNG, NPY) as the surface of a site. Exists only in builds with
// NAVVY_WITH_GDAL.
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

/// What a map was and what was made of it. File coordinates are in the file's own units, all else
/// in metres.
struct TerrainReport {
  std::string file, format;
  int columns = 0, rows = 0;      ///< of the whole file
  double cell_x = 0, cell_y = 0;  ///< [m]
  /// Heights belong to points, the file's area reaches half a cell beyond them.
  bool point_registered = false;
  std::string crs;                                        ///< name; empty: none
  std::string unit, height_unit;                          ///< names as the file gives them
  double metres = 1, height_metres = 1;                   ///< per unit
  Vec2 file_min = Vec2::Zero(), file_max = Vec2::Zero();  ///< extent of the map, file coordinates
  Vec2 site_min = Vec2::Zero(), site_max = Vec2::Zero();  ///< extent of the site, file coordinates
  /// Map cells under the site and a margin of two.
  std::int64_t source_cells = 0;
  GapFill nodata;  ///< of those
  /// Of those on the site, in part at least; without a height.
  std::int64_t site_cells = 0, site_gaps = 0;
  std::string nodata_value;        ///< as declared; "none"
  double height_offset = 0;        ///< W z = file z - offset [m]
  double lowest = 0, highest = 0;  ///< file datum [m]
  SlopeRange slope;
  double repose = 0;               ///< [rad]
  double soil_cell = 0;            ///< [m]
  std::vector<std::string> notes;  ///< traps found in the file
  /// Cells with a number that is no ground's height and not declared as nodata.
  std::int64_t unmarked = 0;
  double unmarked_value = 0;  ///< of the first of them, as the file has it
  /// Its tools read the file: those that a remedy names can mend it.
  bool for_gdal = true;

  /// Some lines for a person.
  std::string text() const;
  /// What was made up on the site: how much of it, from how far, what mends the file. One line;
  /// empty where the map has a height everywhere on the site.
  std::string warning() const;
  double share_filled() const;  ///< of the site's map cells, 0 .. 1
  double filled_from() const;   ///< most cells between a gap and a height, as a length [m]
};

/// Reads the part of `world.ground.file` that the site covers and fills in the surface, datum and
/// georeference of `setup`, whose nx, ny, cell and origin are given. The map is kept at its own
/// resolution and interpolated on demand: up to `held` cells of it are held, of a larger one
/// windows of `side` cells are read when columns are asked for. The heights have the same bits
/// either way.
/// @throws InputError when the file is missing, unreadable, in degrees, turned, without heights
/// here, or when the site is off the map.
TerrainReport import_terrain(const scene::Scene& world, Ground::Setup& setup,
                             double held = limits::kMapCells, int side = WindowedRaster::kSide);

}  // namespace navvy::heightfield
