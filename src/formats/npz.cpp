// SPDX-License-Identifier: Apache-2.0
// NPZ is a ZIP archive of NPY files (NumPy's format 1.0). Entries are stored, not compressed: float
// layers of excavated ground hardly shrink, and readers can map them.
#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "formats/formats.h"
#include "formats/npy_file.h"
#include "formats/zip_archive.h"

namespace navvy::formats {
namespace {

/// Rows of a layer that are held at once.
constexpr int kRows = 256;

std::string header(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers) {
  const heightfield::GroundSetup& s = map.setup();
  nlohmann::ordered_json named = nlohmann::ordered_json::object();
  for (const map::MapLayer layer : layers)
    named[map::info(layer).name] = {{"unit", map::info(layer).unit},
                                    {"meaning", map::info(layer).meaning}};
  nlohmann::ordered_json soils = nlohmann::ordered_json::array();
  for (const auto& soil : s.soils) soils.push_back(soil.name);
  const nlohmann::ordered_json out = {
      {"format_version", 1},
      {"nx", map.nx()},
      {"ny", map.ny()},
      {"cell_m", map.cell()},
      {"origin_m", {map.origin().x(), map.origin().y()}},
      {"order",
       "array[iy, ix]; row 0 has least y, column 0 least x; origin_m is the lower-left corner of "
       "[0, 0]"},
      {"time_s", map.time()},
      {"sequence", map.sequence()},
      {"layers", named},
      {"soils", soils},
      // File coordinates = easting + x / metres_per_unit, from origin_m; file heights =
      // (z + offset) / metres_per_height_unit.
      {"georeference",
       {{"easting", s.easting},
        {"northing", s.northing},
        {"metres_per_unit", s.file_unit},
        {"height_offset_m", s.height_offset},
        {"metres_per_height_unit", s.file_height_unit},
        {"crs_wkt", s.crs_wkt}}},
      {"filled", {{"share", s.filled_share}, {"from_m", s.filled_from}}}};
  // Bytes that are not UTF-8 stand as U+FFFD: a soil's name must not stop the export.
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// NumPy's NPZ: an array (ny, nx) of little-endian float32 for each layer, in W, row 0 = least y,
/// NaN unknown; and `header.json` (format_version, layers with unit and meaning, size, cell,
/// origin, time, soils, georeference, and for a map with gaps the share of its cells that was
/// filled, and from how far).
void write_npz(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               const std::string& path) {
  ZipArchive zip(path);
  // The header first: a reader of the stream knows what comes.
  const std::string head = header(map, layers);
  zip.add("header.json", head);
  const std::string before = npy_header(map.nx(), map.ny());
  const auto bytes = static_cast<std::uint64_t>(map.rect().area()) * sizeof(float);
  for (const map::MapLayer layer : layers) {
    zip.add(map::info(layer).name + ".npy", before.size() + bytes,
            [&map, &before, layer, started = false, y0 = 0]() mutable -> std::string {
              if (!std::exchange(started, true)) return before;
              const int y1 = std::min(y0 + kRows, map.ny());
              const std::vector<float> rows = map.copy(layer, {0, y0, map.nx(), y1});
              y0 = y1;
              return {reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(float)};
            });
  }
  zip.commit();
}

}  // namespace

MapFormat npz_format() {
  return {.name = "npz",
          .extension = ".npz",
          .meaning = "NumPy arrays and header.json, in the world's frame",
          .by_default = map::default_layers(),
          .write = write_npz};
}

}  // namespace navvy::formats
