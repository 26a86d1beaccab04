// SPDX-License-Identifier: Apache-2.0
// NPZ is a ZIP archive of NPY files (NumPy's format 1.0). Entries are stored, not compressed: float
// layers of dug ground hardly shrink, and readers can map them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "planner/formats/formats.h"
#include "planner/formats/json_text.h"
#include "planner/formats/npy_file.h"
#include "planner/formats/part_file.h"

namespace navvy::planner {
namespace {

/// Rows of a layer that are held at once.
constexpr int kRows = 256;

/// As every ZIP has it: polynomial 0xEDB88320, reflected.
class Crc32 {
 public:
  void add(const void* data, std::size_t count) {
    static const std::array<std::uint32_t, 256> table = [] {
      std::array<std::uint32_t, 256> out{};
      for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
        out[i] = c;
      }
      return out;
    }();
    const auto* byte = static_cast<const std::uint8_t*>(data);
    for (std::size_t i = 0; i < count; ++i) sum_ = table[(sum_ ^ byte[i]) & 0xFFu] ^ (sum_ >> 8);
  }
  std::uint32_t value() const { return sum_ ^ 0xFFFFFFFFu; }

 private:
  std::uint32_t sum_ = 0xFFFFFFFFu;
};

/// A ZIP archive without compression, as far as files below 4 GiB need one; entries come piece by
/// piece.
class Zip {
 public:
  explicit Zip(const std::string& path) : file_(path) {}
  /// An entry of `size` bytes, which `add` brings.
  void begin(const std::string& name, std::uint64_t size) {
    name_ = name;
    size_ = size;
    crc_ = Crc32();
    // Where a reader finds the entry.
    offset_ = file_.size();
    put("PK\x03\x04" + head() + name);
  }
  void add(const void* data, std::size_t count) {
    crc_.add(data, count);
    file_.write(data, count);
  }
  void end() {
    // The checksum is known only now.
    const std::string whole = head();
    file_.overwrite(offset_ + 4, whole.data(), whole.size());
    // In the directory: no comment, disk 0, plain file.
    directory_ += "PK\x01\x02";
    append(directory_, 20, 2);
    directory_ += whole;
    append(directory_, 0, 2);
    append(directory_, 0, 2);
    append(directory_, 0, 2);
    append(directory_, 0, 4);
    append(directory_, offset_, 4);
    directory_ += name_;
    ++entries_;
  }
  /// The directory and the end record: its counts and place, which readers look for from the file's
  /// end.
  void commit() {
    const std::uint64_t begin = file_.size();
    std::string last = "PK\x05\x06";
    append(last, 0, 4);
    append(last, entries_, 2);
    append(last, entries_, 2);
    append(last, directory_.size(), 4);
    append(last, begin, 4);
    append(last, 0, 2);
    put(directory_ + last);
    file_.commit();
  }

 private:
  /// Little-endian, as all of ZIP.
  static void append(std::string& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xFF);
  }
  /// Version 2.0, no flags, stored, 1980-01-01 00:00: the same map gives the same bytes.
  std::string head() const {
    std::string out;
    for (const unsigned v : {20u, 0u, 0u, 0u, 33u}) append(out, v, 2);
    append(out, crc_.value(), 4);
    append(out, size_, 4);
    append(out, size_, 4);
    append(out, name_.size(), 2);
    append(out, 0, 2);
    return out;
  }
  void put(const std::string& bytes) { file_.write(bytes.data(), bytes.size()); }

  PartFile file_;
  // Of the entry that is being written; and the directory that comes behind all of them.
  std::string name_, directory_;
  std::uint64_t size_ = 0, offset_ = 0;
  Crc32 crc_;
  unsigned entries_ = 0;
};

std::string header(const TerrainMap& map, const std::vector<Layer>& layers) {
  const heightfield::GroundSetup& s = map.setup();
  std::string out = "{\n  \"format_version\": 1,\n  \"nx\": " + std::to_string(map.nx()) +
                    ",\n  \"ny\": " + std::to_string(map.ny()) +
                    ",\n  \"cell_m\": " + json_number(map.cell()) + ",\n  \"origin_m\": [" +
                    json_number(map.origin().x()) + ", " + json_number(map.origin().y()) +
                    "],\n  \"order\": \"array[iy, ix]; row 0 has least y, column 0 least x; "
                    "origin_m is the lower-left "
                    "corner of [0, 0]\",\n  \"time_s\": " +
                    json_number(map.time()) +
                    ",\n  \"sequence\": " + std::to_string(map.sequence()) + ",\n  \"layers\": {";
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const LayerInfo& each = info(layers[i]);
    out += (i > 0 ? ",\n    " : "\n    ") + json_string(each.name) +
           ": {\"unit\": " + json_string(each.unit) +
           ", \"meaning\": " + json_string(each.meaning) + "}";
  }
  out += "\n  },\n  \"soils\": [";
  for (std::size_t i = 0; i < s.soils.size(); ++i)
    out += (i > 0 ? ", " : "") + json_string(s.soils[i].name);
  // File coordinates = easting + x / metres_per_unit, from origin_m; file heights = (z + offset) /
  // metres_per_unit.
  return out + "],\n  \"georeference\": {\"easting\": " + json_number(s.easting) +
         ", \"northing\": " + json_number(s.northing) +
         ", \"metres_per_unit\": " + json_number(s.file_unit) +
         ", \"height_offset_m\": " + json_number(s.height_offset) +
         ", \"metres_per_height_unit\": " + json_number(s.file_height_unit) +
         ", \"crs_wkt\": " + json_string(s.crs_wkt) +
         "},\n  \"filled\": {\"share\": " + json_number(s.filled_share) +
         ", \"from_m\": " + json_number(s.filled_from) + "}\n}\n";
}

}  // namespace

void write_npz(const TerrainMap& map, const std::vector<Layer>& layers, const std::string& path) {
  const auto bytes = static_cast<std::uint64_t>(map.rect().area()) * sizeof(float) * layers.size();
  // A margin for names and headers.
  if (bytes > std::numeric_limits<std::uint32_t>::max() - (1u << 20))
    throw InputError(
        Fault{Fault::Severity::kError, path, 0, "npz",
              std::to_string(bytes >> 20) + " MiB in " + std::to_string(layers.size()) + " layers",
              "below 4 GiB", "ask for fewer layers, or for a GeoTIFF"});
  // The header first: a reader of the stream knows what comes.
  Zip zip(path);
  const std::string told = header(map, layers), before = npy_header(map.nx(), map.ny());
  zip.begin("header.json", told.size());
  zip.add(told.data(), told.size());
  zip.end();
  for (const Layer layer : layers) {
    zip.begin(info(layer).name + ".npy",
              before.size() + static_cast<std::uint64_t>(map.rect().area()) * sizeof(float));
    zip.add(before.data(), before.size());
    for (int y0 = 0; y0 < map.ny(); y0 += kRows) {
      const std::vector<float> rows =
          map.copy(layer, {0, y0, map.nx(), std::min(y0 + kRows, map.ny())});
      zip.add(rows.data(), rows.size() * sizeof(float));
    }
    zip.end();
  }
  zip.commit();
}

}  // namespace navvy::planner
