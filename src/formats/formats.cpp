// SPDX-License-Identifier: Apache-2.0
// The list of formats. A new format is a file of its own and two lines here.
#include "formats/formats.h"

#include <filesystem>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "formats/part_folder.h"

namespace navvy::formats {

// Each is defined in the file of its format.
MapFormat geotiff_format();
MapFormat npz_format();
MapFormat nav2_format();
MapFormat nav2_scale_format();
MapFormat hillshade_format();
MapFormat relief_format();
MapFormat obj_format();
MapFormat terra_format();
MapFormat mcap_format();
MapFormat bag_format();
MapFormat ply_format();

// A list instead of formats that register themselves: linkers drop unused objects of static
// libraries.
const std::vector<MapFormat>& all_formats() {
  static const std::vector<MapFormat> table = {
      geotiff_format(),   npz_format(),    nav2_format(), nav2_scale_format(),
      hillshade_format(), relief_format(), obj_format(),  terra_format(),
      mcap_format(),      bag_format(),    ply_format(),
  };
  return table;
}

const MapFormat& format_named(const std::string& name) {
  std::vector<std::string> names;
  for (const MapFormat& each : all_formats()) {
    if (each.name == name) return each;
    names.push_back(each.name);
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "format", name,
                         "is not the name of a format", suggestion(name, names)});
}

void write_map(const std::string& format, const map::TerrainMap& map,
               const std::vector<map::MapLayer>& layers, const std::string& path) {
  format_named(format).write(map, layers, path);
}

std::vector<std::string> files_of(const MapFormat& format, const std::string& path) {
  std::vector<std::string> out;
  // The files of a folder are inside it, others stand beside the first file.
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

void require_writable(const MapFormat& format, const std::string& path) {
  if (format.within != nullptr) return require_folder(path, format.within(folder_name(path)));
  for (const std::string& file : files_of(format, path)) navvy::require_writable(file);
}

}  // namespace navvy::formats
