// SPDX-License-Identifier: Apache-2.0
// Maps as files that others read. Each writer has a file of its own here; all write beside the
// target and rename, so that an error, a full disk or a kill leaves the old file or folder, or the
// new one.
#pragma once

#include <string>
#include <vector>

#include "planner/path_file.h"
#include "planner/terrain_map.h"

namespace navvy::planner {

// Every writer takes the layers in the order asked for, at least one.
// @throws FileError naming path and cause; Error for no layer; InputError where a format cannot
// hold what is asked.

/// GeoTIFF, float32, one band a layer with its name and unit, nodata -9999: north up, in the CRS,
/// the coordinates and for heights the datum and unit of the file that the site came from; W where
/// it came from none. In a build without GDAL a FileError says so.
void write_geotiff(const TerrainMap& map, const std::vector<Layer>& layers,
                   const std::string& path);

/// NumPy's NPZ: an array (ny, nx) of little-endian float32 for each layer, in W, row 0 = least y,
/// NaN unknown; and `header.json` (format_version, layers with unit and meaning, size, cell,
/// origin, time, soils, georeference, and of a map with gaps what share of its cells was filled,
/// from how far). Stored, not compressed. @throws InputError above 4 GiB.
void write_npz(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path);

/// nav2's map_server pair from traversability: PATH is the YAML file, the image lies beside it.
/// Takes no other layer. Origin and axes are those of W, whatever the site's georeference: planners
/// count in float32.
///
/// Trinary: 8-bit PGM; free above 0, occupied at 0, unknown 128. Unknown is not the saver's 205,
/// which becomes free where free_thresh is set above 0.196.
void write_nav2_trinary(const TerrainMap& map, const std::vector<Layer>& layers,
                        const std::string& path);
/// Scale: PNG of gray and alpha; occupancy 100 (1 - traversability) to 1 %, unknown by alpha 0.
void write_nav2_scale(const TerrainMap& map, const std::vector<Layer>& layers,
                      const std::string& path);

/// Picture of the surface, lit from the north-west at 45 deg, one pixel a column, north up; unknown
/// is transparent. Takes elevation, elevation_start or target, one layer.
void write_hillshade(const TerrainMap& map, const std::vector<Layer>& layers,
                     const std::string& path);
/// Picture of one layer in colours from its least (dark) to its greatest value (bright),
/// traversability from red to green, cut_fill blue below and red above zero; with the surface's
/// shade where the map has elevation.
void write_relief(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path);

/// Both pictures with lines over them, three columns wide: the first plan of a step red, the second
/// blue, then green and violet, and so on. `format` is "hillshade" or "relief". @throws InputError
/// for another.
void write_picture_with_paths(const std::string& format, const TerrainMap& map,
                              const std::vector<Layer>& layers, const std::string& path,
                              const std::vector<PathLine>& lines);

/// Triangles through column centres in W as binary PLY: x, y, z as doubles, and of every layer
/// asked for a float property at each vertex. Faces only between known columns. Elevation must be
/// in the map.
void write_ply(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path);

/// One surface (elevation, elevation_start or target) as triangles of a Wavefront OBJ, in W.
void write_obj(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path);

/// A folder of NumPy arrays [iy, ix], row 0 = least y, for excavation planners of the Terra kind:
/// images/img_1.npy (int8: -1 the design lies lower, 1 higher, by more than a twentieth of a
/// column's edge; 0 neither), occupancy/img_1.npy (int8: 1 where traversability is 0 or unknown),
/// dumpability/img_1.npy (int8: 1 where soil may be dumped: neither to be dug nor occupied) and
/// distance/img_1.npy (float32: metres to the nearest column to be dug, -1 where there is none).
/// Needs elevation, target and traversability in the map. An earlier folder of these files is
/// replaced as a whole; one that holds anything else stays. @throws InputError also for that.
void write_terra(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path);

/// A ROS 2 bag of one instant, /clock, /terrain/grid_map (grid_map_msgs), /terrain/points
/// (PointCloud2) and, with traversability, /terrain/occupancy: as one MCAP file, or as a rosbag2
/// folder with SQLite storage, which is replaced as Terra's is.
void write_mcap(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path);
void write_bag(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path);

/// A format as the program offers it.
struct Format {
  std::string name;               ///< "geotiff"
  std::string extension;          ///< ".tif"; none: a folder
  std::string meaning;            ///< one line
  std::vector<Layer> by_default;  ///< written when none is asked for
  void (*write)(const TerrainMap&, const std::vector<Layer>&, const std::string&) = nullptr;
  /// Extensions of the files that come with it: ".pgm" beside ".yaml".
  std::vector<std::string> others = {};
  /// Of a folder called `name`: the files in it.
  std::vector<std::string> (*within)(const std::string& name) = nullptr;
  bool needs_design = false;  ///< without one it would say nothing
};
const std::vector<Format>& formats();
/// Paths of all files that `format` writes for `path`, with its extension.
std::vector<std::string> files_of(const Format& format, const std::string& path);
/// Whether `format` could write to `path`, without touching it: for what is known before a map is
/// made. Whether there is room is not known then. @throws FileError, InputError as the writers.
void require_writable(const Format& format, const std::string& path);
/// @throws InputError naming the nearest one.
const Format& format_named(const std::string& name);

}  // namespace navvy::planner
