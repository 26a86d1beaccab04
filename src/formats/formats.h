// SPDX-License-Identifier: Apache-2.0
// Maps as files that other programs read. Each format has a file of its own here. All writers write
// beside the target and rename, so that an error, a full disk or a kill leaves either the old file
// or folder or the new one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "map/map_line.h"
#include "map/terrain_map.h"

namespace navvy::formats {

namespace ros {
class Bag;
}

/// A format that the program offers: its names, and the functions that write it.
struct MapFormat {
  /// Name in options and scenes: "geotiff".
  std::string name;
  /// Ending of the file: ".tif"; empty for a folder.
  std::string extension;
  /// One line for people.
  std::string meaning;
  /// Layers that are written when nobody names any.
  std::vector<map::MapLayer> by_default;
  /// Writes the layers, at least one, in the order given. @throws FileError naming path and cause;
  /// Error for no layer; InputError where the format cannot hold what is asked.
  void (*write)(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                const std::string& path) = nullptr;
  /// Endings of the files that accompany the first: ".pgm" beside ".yaml".
  std::vector<std::string> others = {};
  /// Returns the names of the files in a folder called `name`; null for formats of single files.
  std::vector<std::string> (*within)(const std::string& name) = nullptr;
  /// True for a format that is empty without a design surface.
  bool needs_design = false;
  /// Writes a picture with lines over it, three columns wide, in four colours by the numbers of the
  /// lines; null for formats that cannot. @throws as `write`.
  void (*write_with_lines)(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                           const std::string& path,
                           const std::vector<map::MapLine>& lines) = nullptr;
  /// Opens a file or folder that grows while a world runs; null for formats of one instant.
  /// @throws FileError, InputError.
  std::unique_ptr<ros::Bag> (*open_bag)(const std::string& path) = nullptr;
};

/// Returns every format, in the order in which the program lists them.
const std::vector<MapFormat>& all_formats();
/// Returns the format called `name`. @throws InputError that suggests the nearest name.
const MapFormat& format_named(const std::string& name);
/// Writes a map in the format called `format`. @throws as format_named and MapFormat::write.
void write_map(const std::string& format, const map::TerrainMap& map,
               const std::vector<map::MapLayer>& layers, const std::string& path);
/// Returns the paths of all files that `format` writes for `path`, which has its extension.
std::vector<std::string> files_of(const MapFormat& format, const std::string& path);
/// Checks that `format` could write to `path`, without touching it; the free space of the disk is
/// not checked. @throws FileError, InputError as MapFormat::write.
void require_writable(const MapFormat& format, const std::string& path);

}  // namespace navvy::formats
