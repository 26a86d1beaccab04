// SPDX-License-Identifier: Apache-2.0
// NPZ is a ZIP archive of NPY files (NumPy's format 1.0). Entries are stored, not compressed: float layers of dug
// ground hardly shrink, and readers can map them.
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "planner/formats/formats.h"

namespace navvy::planner {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are written as they lie in memory");

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
  static void put(std::string& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xFF);
  }
  /// Little-endian, as all of ZIP.
  // Entries one after the other, and the directory that comes behind them.
  std::string out_, directory_;
  unsigned entries_ = 0;
};

std::string npy(const std::vector<float>& values, int nx, int ny) {
  // A dictionary as Python prints it.
  std::string dict =
      "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(ny) + ", " + std::to_string(nx) + "), }";
  // Magic, version and length count too; the data begin at a multiple of 64.
  dict.append(63 - (10 + dict.size()) % 64, ' ');
  dict += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(dict.size() & 0xFF);
  out += static_cast<char>(dict.size() >> 8);
  out += dict;
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return out;
}

/// A string of JSON.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      out += code;
    } else {
      out += c;
    }
  }
  return out + '"';
}

/// With all the digits a double has; JSON knows no NaN.
std::string number(double value) {
  char text[40];
  if (value != value) return "null";
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string header(const TerrainMap& map, const std::vector<Layer>& layers) {
  const heightfield::GroundSetup& s = map.setup();
  std::string out = "{\n  \"format_version\": 1,\n  \"nx\": " + std::to_string(map.nx()) +
                    ",\n  \"ny\": " + std::to_string(map.ny()) + ",\n  \"cell_m\": " + number(map.cell()) +
                    ",\n  \"origin_m\": [" + number(map.origin().x()) + ", " + number(map.origin().y()) +
                    "],\n  \"order\": \"array[iy, ix]; row 0 has least y, column 0 least x; origin_m is the lower-left "
                    "corner of [0, 0]\",\n  \"time_s\": " +
                    number(map.time()) + ",\n  \"sequence\": " + std::to_string(map.sequence()) + ",\n  \"layers\": {";
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const LayerInfo& each = info(layers[i]);
    out += (i > 0 ? ",\n    " : "\n    ") + quoted(each.name) + ": {\"unit\": " + quoted(each.unit) +
           ", \"meaning\": " + quoted(each.meaning) + "}";
  }
  out += "\n  },\n  \"soils\": [";
  for (std::size_t i = 0; i < s.soils.size(); ++i) out += (i > 0 ? ", " : "") + quoted(s.soils[i].name);
  // File coordinates = easting + x / metres_per_unit, from origin_m; file heights = (z + offset) / metres_per_unit.
  return out + "],\n  \"georeference\": {\"easting\": " + number(s.easting) + ", \"northing\": " + number(s.northing) +
         ", \"metres_per_unit\": " + number(s.file_unit) + ", \"height_offset_m\": " + number(s.height_offset) +
         ", \"metres_per_height_unit\": " + number(s.file_height_unit) + ", \"crs_wkt\": " + quoted(s.crs_wkt) +
         "}\n}\n";
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
  for (const Layer layer : layers) zip.add(info(layer).name + ".npy", npy(map.copy(layer), map.nx(), map.ny()));
  write_file_atomically(path, zip.bytes());
}

}  // namespace navvy::planner
