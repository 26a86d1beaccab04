// SPDX-License-Identifier: Apache-2.0
// NPZ is a ZIP archive of NPY files (NumPy's format 1.0). Entries are stored, not compressed: float
// layers of excavated ground hardly shrink, and readers can map them.
#include <zip.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <list>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "formats/formats.h"
#include "formats/npy_file.h"

namespace navvy::formats {
namespace {

/// Rows of a layer that are held at once.
constexpr int kRows = 256;

/// A ZIP archive whose entries come piece by piece. Until `commit` the old file stands.
class ZipArchive {
 public:
  /// Returns the next bytes of an entry, none at its end.
  using Next = std::function<std::string()>;

  explicit ZipArchive(const std::string& path) : path_(path), part_(partial_name(path)) {
    navvy::require_writable(path);
    int code = 0;
    archive_ = zip_open(part_.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    if (archive_ != nullptr) return;
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string cause = zip_error_strerror(&error);
    zip_error_fini(&error);
    fail(cause);
  }
  ~ZipArchive() {
    if (archive_ != nullptr) zip_discard(archive_);
  }
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  /// Adds an entry of `size` bytes. `next` is called during `commit`.
  void add(const std::string& name, std::uint64_t size, Next next) {
    Entry& entry = entries_.emplace_back(Entry{std::move(next), size, "", 0, nullptr});
    zip_source_t* source = zip_source_function(archive_, &ZipArchive::serve, &entry);
    if (source == nullptr) fail(zip_strerror(archive_));
    const zip_int64_t index = zip_file_add(archive_, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      fail(zip_strerror(archive_));
    }
    const auto number = static_cast<zip_uint64_t>(index);
    zip_set_file_compression(archive_, number, ZIP_CM_STORE, 0);
    // 1980-01-01 00:00: the same map gives the same bytes.
    zip_file_set_dostime(archive_, number, 0, 33, 0);
  }

  /// Writes all entries and replaces the old file.
  void commit() {
    if (zip_close(archive_) != 0) {
      for (const Entry& entry : entries_)
        if (entry.failure) std::rethrow_exception(entry.failure);
      fail(zip_strerror(archive_));
    }
    archive_ = nullptr;
    commit_file(path_);
  }

 private:
  struct Entry {
    Next next;
    std::uint64_t size;
    std::string bytes;
    std::size_t at;
    std::exception_ptr failure;
  };

  [[noreturn]] void fail(const std::string& cause) const {
    throw FileError("cannot write '" + path_ + "': " + cause);
  }

  /// Copies the next bytes of an entry to `data`; returns their number, -1 after an exception.
  static zip_int64_t read(Entry& entry, char* data, zip_uint64_t length) {
    zip_uint64_t done = 0;
    try {
      while (done < length) {
        if (entry.at == entry.bytes.size()) {
          entry.bytes = entry.next();
          entry.at = 0;
          if (entry.bytes.empty()) break;
        }
        const std::size_t count =
            std::min<std::size_t>(length - done, entry.bytes.size() - entry.at);
        // Bytes, not a text. NOLINTNEXTLINE(bugprone-not-null-terminated-result)
        std::memcpy(data + done, entry.bytes.data() + entry.at, count);
        entry.at += count;
        done += count;
      }
    } catch (...) {
      // The library is C: the exception goes on in `commit`.
      entry.failure = std::current_exception();
      return -1;
    }
    return static_cast<zip_int64_t>(done);
  }

  static zip_int64_t serve(void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
    Entry& entry = *static_cast<Entry*>(user);
    switch (command) {
      case ZIP_SOURCE_SUPPORTS:
        return ZIP_SOURCE_SUPPORTS_READABLE;
      case ZIP_SOURCE_READ:
        return read(entry, static_cast<char*>(data), length);
      case ZIP_SOURCE_STAT: {
        // With its size known an entry below 4 GiB needs no ZIP64.
        auto* stat = static_cast<zip_stat_t*>(data);
        zip_stat_init(stat);
        stat->valid |= ZIP_STAT_SIZE;
        stat->size = entry.size;
        return sizeof(zip_stat_t);
      }
      case ZIP_SOURCE_ERROR: {
        auto* codes = static_cast<int*>(data);
        codes[0] = ZIP_ER_READ;
        codes[1] = 0;
        return 2 * sizeof(int);
      }
      default:
        return 0;
    }
  }

  std::string path_, part_;
  zip_t* archive_ = nullptr;
  // A list: entries keep their address.
  std::list<Entry> entries_;
};

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
  const auto once = [](std::string text) {
    return [text = std::move(text)]() mutable { return std::exchange(text, std::string()); };
  };
  zip.add("header.json", head.size(), once(head));
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
