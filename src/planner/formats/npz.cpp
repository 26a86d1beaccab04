// SPDX-License-Identifier: Apache-2.0
// NPZ is a ZIP archive of NPY files (NumPy's format 1.0). Entries are stored, not compressed: float layers of dug
// ground hardly shrink, and readers can map them.
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "planner/formats/formats.h"
#include "planner/formats/json_text.h"
#include "planner/formats/npy_file.h"

namespace navvy::planner {
namespace {

/// As every ZIP has it: polynomial 0xEDB88320, reflected.
std::uint32_t crc32(const std::string& bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> out{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
      out[i] = c;
    }
    return out;
  }();
  std::uint32_t c = 0xFFFFFFFFu;
  for (const char byte : bytes) c = table[(c ^ static_cast<std::uint8_t>(byte)) & 0xFFu] ^ (c >> 8);
  return c ^ 0xFFFFFFFFu;
}

/// A ZIP archive without compression, as far as files below 4 GiB need one.
class Zip {
 public:
  void add(const std::string& name, const std::string& content) {
    // Where a reader finds the entry.
    const auto offset = out_.size();
    // Version 2.0, no flags, stored, 1980-01-01 00:00: the same map gives the same bytes.
    std::string head;
    for (const unsigned v : {20u, 0u, 0u, 0u, 33u}) put(head, v, 2);
    put(head, crc32(content), 4);
    put(head, content.size(), 4);
    put(head, content.size(), 4);
    put(head, name.size(), 2);
    put(head, 0, 2);
    out_ += "PK\x03\x04" + head + name + content;
    // In the directory: no comment, disk 0, plain file.
    directory_ += "PK\x01\x02";
    put(directory_, 20, 2);
    directory_ += head;
    put(directory_, 0, 2);
    put(directory_, 0, 2);
    put(directory_, 0, 2);
    put(directory_, 0, 4);
    put(directory_, offset, 4);
    directory_ += name;
    ++entries_;
  }
  std::vector<char> bytes() const {
    // The end record: counts and place of the directory, which readers look for from the file's end.
    std::string all = out_ + directory_ + "PK\x05\x06";
    put(all, 0, 4);
    put(all, entries_, 2);
    put(all, entries_, 2);
    put(all, directory_.size(), 4);
    put(all, out_.size(), 4);
    put(all, 0, 2);
    return {all.begin(), all.end()};
  }

 private:
  /// Little-endian, as all of ZIP.
  static void put(std::string& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xFF);
  }
  // Entries one after the other, and the directory that comes behind them.
  std::string out_, directory_;
  unsigned entries_ = 0;
};

std::string header(const TerrainMap& map, const std::vector<Layer>& layers) {
  const heightfield::GroundSetup& s = map.setup();
  std::string out = "{\n  \"format_version\": 1,\n  \"nx\": " + std::to_string(map.nx()) +
                    ",\n  \"ny\": " + std::to_string(map.ny()) + ",\n  \"cell_m\": " + json_number(map.cell()) +
                    ",\n  \"origin_m\": [" + json_number(map.origin().x()) + ", " + json_number(map.origin().y()) +
                    "],\n  \"order\": \"array[iy, ix]; row 0 has least y, column 0 least x; origin_m is the lower-left "
                    "corner of [0, 0]\",\n  \"time_s\": " +
                    json_number(map.time()) + ",\n  \"sequence\": " + std::to_string(map.sequence()) +
                    ",\n  \"layers\": {";
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const LayerInfo& each = info(layers[i]);
    out += (i > 0 ? ",\n    " : "\n    ") + json_string(each.name) + ": {\"unit\": " + json_string(each.unit) +
           ", \"meaning\": " + json_string(each.meaning) + "}";
  }
  out += "\n  },\n  \"soils\": [";
  for (std::size_t i = 0; i < s.soils.size(); ++i) out += (i > 0 ? ", " : "") + json_string(s.soils[i].name);
  // File coordinates = easting + x / metres_per_unit, from origin_m; file heights = (z + offset) / metres_per_unit.
  return out + "],\n  \"georeference\": {\"easting\": " + json_number(s.easting) +
         ", \"northing\": " + json_number(s.northing) + ", \"metres_per_unit\": " + json_number(s.file_unit) +
         ", \"height_offset_m\": " + json_number(s.height_offset) +
         ", \"metres_per_height_unit\": " + json_number(s.file_height_unit) +
         ", \"crs_wkt\": " + json_string(s.crs_wkt) + "}\n}\n";
}

}  // namespace

void write_npz(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path) {
  const auto bytes = static_cast<std::uint64_t>(map.rect().area()) * sizeof(float) * layers.size();
  // A margin for names and headers.
  if (bytes > std::numeric_limits<std::uint32_t>::max() - (1u << 20))
    throw InputError(Fault{Fault::Severity::kError, path, 0, "npz",
                           std::to_string(bytes >> 20) + " MiB in " + std::to_string(layers.size()) + " layers",
                           "below 4 GiB", "ask for fewer layers, or for a GeoTIFF"});
  // The header first: a reader of the stream knows what comes.
  Zip zip;
  zip.add("header.json", header(map, layers));
  for (const Layer layer : layers) zip.add(info(layer).name + ".npy", npy_bytes(map.copy(layer), map.nx(), map.ny()));
  write_file_atomically(path, zip.bytes());
}

}  // namespace navvy::planner
