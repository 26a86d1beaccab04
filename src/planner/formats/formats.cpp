// SPDX-License-Identifier: Apache-2.0
// The table of formats that the program offers; the writers stand beside this, a file each.
#include "planner/formats/formats.h"

#include <filesystem>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "planner/formats/part_folder.h"

namespace navvy::planner {

const std::vector<Format>& formats() {
  // One row a format: a new one needs its file and this.
  static const std::vector<Format> table = {
      {"geotiff", ".tif", "GeoTIFF, one band a layer, georeferenced", all_layers(), write_geotiff},
      {"npz", ".npz", "NumPy arrays and header.json, in the world's frame", all_layers(),
       write_npz},
      {"nav2",
       ".yaml",
       "nav2 map_server pair, free / occupied / unknown",
       {Layer::kTraversability},
       write_nav2_trinary,
       {".pgm"}},
      {"nav2-scale",
       ".yaml",
       "the same in mode scale, 0 to 100",
       {Layer::kTraversability},
       write_nav2_scale,
       {".png"}},
      {"hillshade",
       ".png",
       "picture of a surface, lit from the north-west",
       {Layer::kElevation},
       write_hillshade},
      {"relief", ".png", "picture of one layer in colours", {Layer::kElevation}, write_relief},
      {"obj", ".obj", "triangles of one surface", {Layer::kElevation}, write_obj},
      {"terra",
       "",
       "folder of NumPy arrays: target -1/0/1, occupancy, dumpability, distance",
       {Layer::kTarget, Layer::kElevation, Layer::kTraversability},
       write_terra,
       {},
       terra_files,
       true},
      {"mcap",
       ".mcap",
       "ROS 2 messages in one file: grid_map, occupancy, points",
       {Layer::kElevation, Layer::kTraversability},
       write_mcap},
      {"bag",
       "",
       "the same as a rosbag2 folder (SQLite)",
       {Layer::kElevation, Layer::kTraversability},
       write_bag,
       {},
       bag_files},
      {"ply", ".ply", "triangles with layers at the vertices", {Layer::kElevation}, write_ply},
  };
  return table;
}

const Format& format_named(const std::string& name) {
  // A word that fits none is answered by the nearest.
  std::vector<std::string> names;
  for (const Format& each : formats()) {
    if (each.name == name) return each;
    names.push_back(each.name);
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "format", name, "no such format",
                         suggestion(name, names)});
}

std::vector<std::string> files_of(const Format& format, const std::string& path) {
  std::vector<std::string> out;
  // A folder's files lie in it, others beside the first one.
  if (format.within != nullptr) {
    for (const std::string& name : format.within(folder_name(path)))
      out.push_back(path + "/" + name);
    return out;
  }
  out.push_back(path);
  for (const std::string& end : format.others)
    out.push_back(std::filesystem::path(path).replace_extension(end).string());
  return out;
}

void require_writable(const Format& format, const std::string& path) {
  if (format.within != nullptr) return require_folder(path, format.within(folder_name(path)));
  for (const std::string& file : files_of(format, path)) navvy::require_writable(file);
}

}  // namespace navvy::planner
