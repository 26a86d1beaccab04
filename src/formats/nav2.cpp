// SPDX-License-Identifier: Apache-2.0
// The pair of files that nav2's map_server loads. Pixel p becomes an occupancy of (255 - p) / 255,
// which free_thresh and occupied_thresh divide. Row 0 of the image has the greatest y.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/error.h"
#include "core/file.h"
#include "formats/formats.h"
#include "formats/png_file.h"

namespace navvy::formats {
namespace {

/// Lies half way between the thresholds in common use. The saver of nav2 writes 205, an occupancy
/// of 0.19608, which is free for everyone who sets free_thresh to 0.25.
constexpr std::uint8_t kUnknownPixel = 128;

// The pair holds one value per cell, and nav2 reads it as occupancy.
void require_traversability(const std::vector<map::MapLayer>& layers, const std::string& path) {
  if (layers.size() == 1 && layers[0] == map::MapLayer::kTraversability) return;
  throw InputError(Fault{Fault::Severity::kError, path, 0, "nav2",
                         layers.empty() ? "" : map::info(layers[0]).name,
                         "a map of occupancy holds traversability alone", "omit --layers"});
}

/// Returns the image beside a YAML file: "map.png" for "map.yaml" and ".png".
std::string beside(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

/// Writes the image first, so that a YAML file never names a missing image.
void write_pair(const map::TerrainMap& map, const std::string& path, const std::string& image,
                const std::vector<char>& bytes, const char* mode, const char* thresholds) {
  if (image == path)
    throw InputError(Fault{Fault::Severity::kError, path, 0, "nav2", path,
                           "the YAML file's name ends in .yaml",
                           "the image beside it takes the other ending"});
  char text[400];
  std::snprintf(text, sizeof text,
                "mode: %s\nresolution: %.9g\norigin: [%.9g, %.9g, 0.0]\nnegate: 0\n%s", mode,
                map.cell(), map.origin().x(), map.origin().y(), thresholds);
  write_file_atomically(image, bytes);
  // Names are quoted because they may hold characters that YAML interprets.
  std::string name = std::filesystem::path(image).filename().string(), quoted = "\"";
  for (const char c : name)
    quoted += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  write_file_atomically(path, "image: " + quoted + "\"\n" + text);
}

/// Calls `put` with the traversability of each column, from the greatest y down.
template <class Put>
void rows_from_above(const map::TerrainMap& map, const Put& put) {
  for (int iy = map.ny() - 1; iy >= 0; --iy)
    for (int ix = 0; ix < map.nx(); ++ix) put(map.at(map::MapLayer::kTraversability, ix, iy));
}

// A column at any limit is an obstacle; every other known one is free.
void write_nav2_trinary(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                        const std::string& path) {
  require_traversability(layers, path);
  const std::string head =
      "P5\n" + std::to_string(map.nx()) + " " + std::to_string(map.ny()) + "\n255\n";
  std::vector<char> bytes(head.begin(), head.end());
  rows_from_above(map, [&](float t) {
    const int pixel = t > 0 ? 254 : t <= 0 ? 0 : kUnknownPixel;
    bytes.push_back(static_cast<char>(pixel));
  });
  write_pair(map, path, beside(path, ".pgm"), bytes, "trinary",
             "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

// The occupancy follows traversability linearly; alpha marks unknown columns, because every gray
// value is an occupancy.
void write_nav2_scale(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                      const std::string& path) {
  require_traversability(layers, path);
  std::vector<std::uint8_t> pixels;
  rows_from_above(map, [&](float t) {
    const bool known = t == t;
    pixels.push_back(
        known ? static_cast<std::uint8_t>(std::lround(255 * std::fmin(std::fmax(t, 0.0f), 1.0f)))
              : 0);
    pixels.push_back(known ? 255 : 0);
  });
  // The thresholds are at the ends of the range, so that the occupancies 0 to 100 of the loader are
  // those of the map.
  write_pair(map, path, beside(path, ".png"),
             png_bytes(PixelKind::kGrayAlpha, map.nx(), map.ny(), pixels), "scale",
             "occupied_thresh: 1.0\nfree_thresh: 0.0\n");
}

}  // namespace

MapFormat nav2_format() {
  return {.name = "nav2",
          .extension = ".yaml",
          .meaning = "nav2 map_server pair, free / occupied / unknown",
          .by_default = {map::MapLayer::kTraversability},
          .write = write_nav2_trinary,
          .others = {".pgm"}};
}

MapFormat nav2_scale_format() {
  return {.name = "nav2-scale",
          .extension = ".yaml",
          .meaning = "the same in mode scale, 0 to 100",
          .by_default = {map::MapLayer::kTraversability},
          .write = write_nav2_scale,
          .others = {".png"}};
}

}  // namespace navvy::formats
