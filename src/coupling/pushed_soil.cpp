// SPDX-License-Identifier: Apache-2.0
#include "coupling/pushed_soil.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/soil_values.h"

namespace navvy::coupling {
namespace {

// Largest distance to the start of a strip in widths: beyond the other tyre of a pair, and a second
// pair beside it.
constexpr double kFarthest = 4;

}  // namespace

// Overlap of two intervals across the direction of travel.
double PushedSoil::covered(double off, double width, double cell) {
  const double low = std::max(off - 0.5 * cell, -0.5 * width),
               high = std::min(off + 0.5 * cell, 0.5 * width);
  return std::max(0.0, (high - low) / cell);
}

// Keeps the layers apart, so that each soil is laid down as itself.
void PushedSoil::take(const Place& place, double depth) {
  const double height = ground_.height(place.ix, place.iy);
  Load load{place, {}};
  ground_.take_above(place.ix, place.iy, height - place.covered * depth, load.layers);
  if (!load.layers.empty()) loads_.push_back(std::move(load));
}

// Walks outward column by column until the strip is as wide as the tyre or track.
std::vector<PushedSoil::Strip> PushedSoil::strip(
    const Place& from, double sign, const std::function<bool(int, int)>& loaded) const {
  const double cell = ground_.cell();
  const Vec2 start = ground_.origin() + cell * Vec2(from.ix + 0.5, from.iy + 0.5);
  const Vec2 step = sign * cell * from.across;
  std::vector<Strip> out;
  double left = from.width;  // of the strip
  const int most = static_cast<int>(std::ceil(kFarthest * from.width / cell)) + 4;
  for (int i = 1; i <= most && left > 0; ++i) {
    // Not between the tyres of a pair.
    if (sign * from.left + i * cell < from.reach) continue;
    const Vec2 p = start + i * step;
    const Vec2i column = ground_.column_at(p.x(), p.y());
    if (!ground_.contains(column.x(), column.y())) break;
    // A strip at an angle to the columns may hit one column in two successive steps; it then counts
    // twice.
    if (!loaded(column.x(), column.y())) out.push_back({column, std::min(left / cell, 1.0)});
    if (!out.empty()) left -= cell;
  }
  return out;
}

void PushedSoil::spread(const heightfield::SoilLayer& layer, const std::vector<Strip>& strip) {
  double all = 0;
  for (const Strip& one : strip) all += one.share;
  // Divide the remaining mass by the remaining shares, so that the last column takes the rest.
  std::int64_t left = layer.mass;
  for (const Strip& one : strip) {
    heightfield::SoilLayer part = layer;
    part.mass = &one == &strip.back()
                    ? left
                    : std::clamp<std::int64_t>(
                          std::llround(static_cast<double>(left) * one.share / all), 0, left);
    left -= part.mass;
    all -= one.share;
    ground_.put(one.column.x(), one.column.y(), part);
  }
}

// Loosens the soil before it is laid down.
void PushedSoil::deposit_down(const std::function<bool(int, int)>& loaded) {
  const std::vector<scene::Soil>& soils = ground_.setup().soils;
  for (const Load& load : loads_) {
    const Place& from = load.place;
    const double pressed = ground_.height(from.ix, from.iy);
    const std::vector<Strip> to_left = strip(from, 1, loaded), to_right = strip(from, -1, loaded);
    // The part of the column left of the middle line goes left. All goes to one side if the other
    // has no space.
    double share = std::clamp(0.5 + from.left / ground_.cell(), 0.0, 1.0);
    if (to_left.empty()) share = 0;
    if (to_right.empty()) share = 1;
    for (const heightfield::SoilLayer& layer : load.layers) {
      if (to_left.empty() && to_right.empty()) {
        ground_.put(from.ix, from.iy, layer);
        continue;
      }
      heightfield::SoilLayer loose = layer;
      const scene::Soil& soil = soils[layer.soil];
      loose.specific_volume = std::max(layer.specific_volume, static_cast<float>(soil.swell));
      loose.plastic_shear = std::max(layer.plastic_shear, scene::remoulded_shear(soil));
      loose.mass = std::llround(static_cast<double>(layer.mass) * share);
      if (loose.mass > 0) spread(loose, to_left);
      loose.mass = layer.mass - loose.mass;
      if (loose.mass > 0) spread(loose, to_right);
    }
    if (to_left.empty() && to_right.empty()) ground_.compact_to(from.ix, from.iy, pressed);
  }
  loads_.clear();
}

}  // namespace navvy::coupling
