// SPDX-License-Identifier: Apache-2.0
// Writes maps as files for other programs. Each format is implemented in a source file of its own.
// All writers write a new file next to the target and then rename it: after an error, a full disk
// or a kill, either the old or the complete new file (or folder) exists.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "map/map_line.h"
#include "map/terrain_map.h"

namespace navvy::formats {

namespace ros {
/// A ROS bag that is being written (formats/ros/bag.h).
class Bag;
}  // namespace ros

/// A map file format: its names, and the functions that write it.
struct MapFormat {
  /// Name in options and scenes, such as "geotiff".
  std::string name;
  /// File name extension, such as ".tif"; empty for a format that is a folder.
  std::string extension;
  /// One-line description for the user.
  std::string meaning;
  /// Layers that are written if none are requested.
  std::vector<map::MapLayer> by_default;
  /// Function that writes at least one layer of `map` to `path`, in the order of `layers`. @throws
  /// FileError naming path and cause; Error if `layers` is empty; InputError if the format cannot
  /// represent the request.
  void (*write)(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                const std::string& path) = nullptr;
  /// Extensions of the additional files that the format writes next to the first one, such as
  /// ".pgm" next to a ".yaml" file.
  std::vector<std::string> others = {};
  /// Function that returns the names of the files in a folder of this format, given the folder's
  /// `name`. Null for formats that are not a folder.
  std::vector<std::string> (*within)(const std::string& name) = nullptr;
  /// True if the format contains nothing for a scene without a design surface.
  bool needs_design = false;
  /// Function that writes a picture of the map with `lines` drawn over it, three columns wide. Each
  /// line has one of four colours, selected by its number. Null for formats that cannot do this.
  /// @throws as `write`.
  void (*write_with_lines)(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                           const std::string& path,
                           const std::vector<map::MapLine>& lines) = nullptr;
  /// Function that opens a file or folder at `path` to which messages are added while a simulation
  /// runs. Null for formats that contain a single instant. @throws FileError, InputError.
  std::unique_ptr<ros::Bag> (*open_bag)(const std::string& path) = nullptr;
};

/// Returns all formats, in the order in which the program lists them.
const std::vector<MapFormat>& all_formats();
/// Returns the format called `name`. @throws InputError that suggests the most similar name.
const MapFormat& format_named(const std::string& name);
/// Writes `layers` of `map` to `path` in the format called `format`. @throws as format_named and
/// MapFormat::write.
void write_map(const std::string& format, const map::TerrainMap& map,
               const std::vector<map::MapLayer>& layers, const std::string& path);
/// Returns the paths of all files that `format` writes if it is given `path`, which must have the
/// format's extension.
std::vector<std::string> files_of(const MapFormat& format, const std::string& path);
/// Checks that `format` can write to `path`, without changing anything there. Free disk space is
/// not checked. @throws FileError or InputError as MapFormat::write.
void require_writable(const MapFormat& format, const std::string& path);

}  // namespace navvy::formats
