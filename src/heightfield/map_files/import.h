// SPDX-License-Identifier: Apache-2.0
// Reads terrain files (ESRI ASCII, PNG, NPY, with NAVVY_WITH_GDAL also GeoTIFF) as the initial
// surface of a site.
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

/// Readers of map files: those that the build uses, or, for tests that compare them, those that
/// need no GDAL, or GDAL for all that it can read.
enum class MapReader { kBuild, kPlain, kGdal };

/// Properties of a terrain file, and of the site made from it. File coordinates have the file's own
/// units; everything else is in metres and radians.
struct TerrainReport {
  /// Path of the file (`file`), and the name of its format as in GDAL (`format`).
  std::string file, format;
  /// Number of cells per row (`columns`) and number of rows (`rows`) of the whole file.
  int columns = 0, rows = 0;
  /// Edge lengths of a cell along x and y [m].
  double cell_x = 0, cell_y = 0;
  /// True if the heights belong to points at the cell centres. The area of the file then extends
  /// half a cell beyond the outermost points.
  bool point_registered = false;
  /// Name of the coordinate reference system (CRS); empty if the file has none.
  std::string crs;
  /// Names of the units of the coordinates (`unit`) and of the heights (`height_unit`), as in the
  /// file.
  std::string unit, height_unit;
  /// Metres per unit of the coordinates (`metres`) and of the heights (`height_metres`).
  double metres = 1, height_metres = 1;
  /// Corners of the whole file with the smallest and the largest coordinates, in file coordinates.
  Vec2 file_min = Vec2::Zero(), file_max = Vec2::Zero();
  /// Corners of the site with the smallest and the largest coordinates, in file coordinates.
  Vec2 site_min = Vec2::Zero(), site_max = Vec2::Zero();
  /// Number of file cells that were read: those under the site, with a margin of two cells around
  /// it.
  std::int64_t source_cells = 0;
  /// Gaps among the file cells that were read (`source_cells`).
  GapFill nodata;
  /// Number of file cells at least partly on the site, and how many of them had no height.
  std::int64_t site_cells = 0, site_gaps = 0;
  /// Value that the file declares to mean "no height", or "none".
  std::string nodata_value;
  /// Height that was subtracted from the file's heights to obtain world z [m].
  double height_offset = 0;
  /// Minimum and maximum height in the vertical datum of the file [m].
  double lowest = 0, highest = 0;
  /// Distribution of the map's slopes under the site.
  SlopeRange slope;
  /// Angle of repose of the surface soil [rad].
  double repose = 0;
  /// Edge length of a terrain column [m].
  double soil_cell = 0;
  /// Potential problems found in the file, one sentence each.
  std::vector<std::string> notes;
  /// Number of cells whose value cannot be a ground height although the file does not declare it as
  /// nodata.
  std::int64_t unmarked = 0;
  /// First cell value in the file that cannot be a ground height; meaningful if `unmarked` > 0.
  double unmarked_value = 0;
  /// True if GDAL's command line tools can read the file. Messages then suggest them as a remedy.
  bool for_gdal = true;

  /// Returns the report as several lines of text for the user.
  std::string text() const;
  /// Returns a one-line warning about heights that were filled in on the site: their fraction, the
  /// largest distance to a known height, and the remedy. Empty if the file has a height everywhere
  /// on the site.
  std::string warning() const;
  /// Returns the fraction of `site_cells` whose heights were filled in, 0 to 1.
  double share_filled() const;
  /// Returns the largest distance from a filled cell to a known height [m].
  double filled_from() const;
};

/// Reads the part of the terrain file `world.ground.file` that the site covers, and sets the
/// surface, datum and georeference of `setup`. The caller has set nx, ny, cell and origin of
/// `setup`. The map keeps its own resolution; column heights are interpolated on demand.
/// @param held maximum number of file cells to keep in memory. A larger map is read in windows on
/// demand; the heights are bit-identical either way.
/// @param side number of cells along each side of such a window
/// @param reader reader of the file; only tests choose
/// @returns properties of the file and the site
/// @throws InputError if the file is missing, unreadable, in degrees, rotated, or has no heights on
/// the site, or if the site is not within the map.
TerrainReport import_terrain(const scene::Scene& world, Ground::Setup& setup,
                             double held = limits::kMapCells, int side = WindowedRaster::kSide,
                             MapReader reader = MapReader::kBuild);

}  // namespace navvy::heightfield
