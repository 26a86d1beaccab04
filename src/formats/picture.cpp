// SPDX-License-Identifier: Apache-2.0
// Hillshade, and colours of a layer: one pixel per column, north up.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "core/math.h"
#include "formats/formats.h"
#include "formats/png_file.h"

namespace navvy::formats {
namespace {

using Colour = std::array<double, 3>;

/// Returns the brightness 0..1 of column (ix, iy) under a sun in the north-west, 45 deg high; NaN
/// where the column is unknown.
double shade(const map::TerrainMap& map, map::MapLayer surface, int ix, int iy) {
  const auto z = [&](int x, int y) {
    return static_cast<double>(
        map.at(surface, std::clamp(x, 0, map.nx() - 1), std::clamp(y, 0, map.ny() - 1)));
  };
  const auto slope = [&](double before, double here, double after) {
    // Beside an unknown column the known side alone counts.
    if (before != before) return (after - here) / map.cell();
    if (after != after) return (here - before) / map.cell();
    return (after - before) / (2 * map.cell());
  };
  const double here = z(ix, iy);
  const Vec3 n = Vec3(-slope(z(ix - 1, iy), here, z(ix + 1, iy)),
                      -slope(z(ix, iy - 1), here, z(ix, iy + 1)), 1);
  // Direction of the sun in W: x is east, y is north.
  const Vec3 sun = Vec3(-1, 1, std::sqrt(2.0)).normalized();
  return here == here ? std::clamp(n.normalized().dot(sun), 0.0, 1.0) : here;
}

/// Interpolates between the colours of `stops`, evenly spaced, at 0 <= t <= 1.
Colour between(const std::vector<Colour>& stops, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double f = at - static_cast<double>(i);
  Colour out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = (1 - f) * stops[i][c] + f * stops[i + 1][c];
  return out;
}

/// Returns the colours of a layer: dark to bright, and with a meaning where its type has one.
const std::vector<Colour>& stops_of(map::LayerType type) {
  static const std::vector<Colour> plain = {{0.15, 0.11, 0.24}, {0.20, 0.29, 0.48},
                                            {0.20, 0.50, 0.50}, {0.47, 0.68, 0.37},
                                            {0.85, 0.82, 0.47}, {0.98, 0.96, 0.86}};
  static const std::vector<Colour> good = {
      {0.72, 0.16, 0.14}, {0.91, 0.71, 0.28}, {0.36, 0.62, 0.34}};
  static const std::vector<Colour> difference = {
      {0.16, 0.30, 0.62}, {0.94, 0.94, 0.92}, {0.70, 0.20, 0.15}};
  if (type == map::LayerType::kShare) return good;
  return type == map::LayerType::kDifference ? difference : plain;
}

/// Returns the values at the two ends of the colours.
std::pair<double, double> range_of(map::LayerType type, const std::vector<float>& values) {
  if (type == map::LayerType::kShare || type == map::LayerType::kFlag) return {0, 1};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const float v : values)
    if (v == v)
      low = std::min(low, static_cast<double>(v)), high = std::max(high, static_cast<double>(v));
  // A flat layer, or one that is unknown everywhere: one colour in the middle.
  if (!(low < high)) return {low - 0.5, low + 0.5};
  // Zero lies in the middle of a difference.
  const double most = std::max(std::abs(low), std::abs(high));
  return type == map::LayerType::kDifference ? std::pair{-most, most} : std::pair{low, high};
}

// A picture shows one layer; hillshade also needs a height.
void require_one(const char* format, const std::vector<map::MapLayer>& layers,
                 const std::string& path, bool fits) {
  if (layers.size() == 1 && fits) return;
  std::string found;
  for (const map::MapLayer layer : layers)
    found += (found.empty() ? "" : ",") + map::info(layer).name;
  throw InputError(Fault{
      Fault::Severity::kError, path, 0, format, found,
      fits ? "a picture shows one layer" : "shows a surface: elevation, elevation_start or target",
      "ask for one picture a layer, or for a GeoTIFF"});
}

/// Number of the line over each column, 0 for none; empty where there are no lines.
using Overlay = std::vector<std::uint8_t>;

// Draws lines three columns wide, so that they stay visible when the picture is scaled down.
Overlay overlay_of(const map::TerrainMap& map, const std::vector<map::MapLine>& lines) {
  if (lines.empty()) return {};
  Overlay out(static_cast<std::size_t>(map.rect().area()));
  const auto mark = [&](const Vec2& p, int plan) {
    const Vec2i c = ((p - map.origin()) / map.cell()).array().floor().cast<int>();
    for (int iy = c.y() - 1; iy <= c.y() + 1; ++iy)
      for (int ix = c.x() - 1; ix <= c.x() + 1; ++ix)
        if (map.contains(ix, iy))
          out[static_cast<std::size_t>(iy) * static_cast<std::size_t>(map.nx()) +
              static_cast<std::size_t>(ix)] = static_cast<std::uint8_t>(1 + (plan - 1) % 4);
  };
  // Later lines cover earlier ones. Steps of half a column close the gaps between places.
  for (const map::MapLine& line : lines)
    for (std::size_t i = 0; i < line.places.size(); ++i) {
      const Vec2& from = line.places[i == 0 ? 0 : i - 1];
      const Vec2 step = line.places[i] - from;
      const int parts = std::clamp(static_cast<int>(2 * step.norm() / map.cell()), 1, 100000);
      for (int k = 0; k <= parts; ++k) mark(from + step * k / parts, line.number);
    }
  return out;
}

/// Writes a picture. `colour(ix, iy, out)` returns false where the column is unknown.
template <class Paint>
void write_picture(const map::TerrainMap& map, const std::string& path, const Overlay& overlay,
                   const Paint& colour) {
  static const std::array<Colour, 4> inks = {Colour{0.85, 0.10, 0.10}, Colour{0.10, 0.35, 0.90},
                                             Colour{0.05, 0.60, 0.25}, Colour{0.60, 0.20, 0.75}};
  // The first row of the picture is the northern edge.
  std::vector<std::uint8_t> pixels;
  pixels.reserve(4 * static_cast<std::size_t>(map.rect().area()));
  for (int iy = map.ny() - 1; iy >= 0; --iy)
    for (int ix = 0; ix < map.nx(); ++ix) {
      Colour rgb{};
      bool known = colour(ix, iy, rgb);
      const std::size_t column = static_cast<std::size_t>(iy) * static_cast<std::size_t>(map.nx()) +
                                 static_cast<std::size_t>(ix);
      if (!overlay.empty() && overlay[column] > 0) rgb = inks[overlay[column] - 1u], known = true;
      for (const double c : rgb)
        pixels.push_back(
            known ? static_cast<std::uint8_t>(std::lround(255 * std::clamp(c, 0.0, 1.0))) : 0);
      pixels.push_back(known ? 255 : 0);
    }
  write_file_atomically(path, png_bytes(PixelKind::kRgba, map.nx(), map.ny(), pixels));
}

void write_hillshade_with_lines(const map::TerrainMap& map,
                                const std::vector<map::MapLayer>& layers, const std::string& path,
                                const std::vector<map::MapLine>& lines) {
  require_one("hillshade", layers, path, !layers.empty() && map::info(layers[0]).height());
  write_picture(map, path, overlay_of(map, lines), [&](int ix, int iy, Colour& rgb) {
    const double light = shade(map, layers[0], ix, iy);
    rgb.fill(light);
    return light == light;
  });
}

// The colours run over the range of the whole map, so that one picture uses all of them.
void write_relief_with_lines(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                             const std::string& path, const std::vector<map::MapLine>& lines) {
  require_one("relief", layers, path, true);
  const map::MapLayer layer = layers[0];
  const auto [low, high] = range_of(map::info(layer).type, map.copy(layer));
  const double least = low, span = high - low;
  write_picture(map, path, overlay_of(map, lines), [&](int ix, int iy, Colour& rgb) {
    const double value = static_cast<double>(map.at(layer, ix, iy));
    if (!(value == value)) return false;
    rgb = between(stops_of(map::info(layer).type), (value - least) / span);
    // The surface shades the colours; level ground keeps its colour.
    const double light = shade(map, map::MapLayer::kElevation, ix, iy) / std::sqrt(0.5);
    for (double& c : rgb) c *= light == light ? 0.45 + 0.55 * light : 1;
    return true;
  });
}

void write_hillshade(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                     const std::string& path) {
  write_hillshade_with_lines(map, layers, path, {});
}

void write_relief(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                  const std::string& path) {
  write_relief_with_lines(map, layers, path, {});
}

}  // namespace

MapFormat hillshade_format() {
  return {.name = "hillshade",
          .extension = ".png",
          .meaning = "picture of a surface, lit from the north-west",
          .by_default = {map::MapLayer::kElevation},
          .write = write_hillshade,
          .write_with_lines = write_hillshade_with_lines};
}

MapFormat relief_format() {
  return {.name = "relief",
          .extension = ".png",
          .meaning = "picture of one layer in colours",
          .by_default = {map::MapLayer::kElevation},
          .write = write_relief,
          .write_with_lines = write_relief_with_lines};
}

}  // namespace navvy::formats
