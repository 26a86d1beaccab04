// SPDX-License-Identifier: Apache-2.0
#include "record/shape_score.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace navvy::record {
namespace {

/// Depth from which on a column of a side counts [m]; nearer to the edge the ground rounds it off.
constexpr double kSideDepth = 0.1;
/// Slopes of sides: flatter is floor, steeper is a wall whose angle columns do not show [-].
constexpr double kLeastSlope = 0.1, kMostSlope = 5;
/// Difference of the rises to both neighbours from which on a column is at an edge [share].
constexpr double kBend = 0.3;
/// Least number of columns whose angle is reported.
constexpr int kLeastColumns = 20;

/// Sums for the regression of heights of the ground on those of the design.
struct Regression {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, slope = 0;
  void add(double design, double ground, double steep) {
    n += 1;
    x += design;
    y += ground;
    xx += design * design;
    xy += design * ground;
    slope += steep;
  }
  /// Returns the rise of the ground per rise of the design; nothing if all heights are the same.
  std::optional<double> rate() const {
    const double spread = n * xx - x * x;
    if (n < kLeastColumns || spread < 1e-9) return std::nullopt;
    return (n * xy - x * y) / spread;
  }
};

/// Returns the steepness of the design at a column [-]; nothing at an edge of a side, where the
/// rise to one neighbour differs from that to the other, or if a neighbour has no height.
std::optional<double> steepness(const heightfield::DesignSurface& design, int ix, int iy,
                                double cell) {
  double square = 0;
  for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
    if (!has_design(design, ix + dx, iy + dy) || !has_design(design, ix - dx, iy - dy))
      return std::nullopt;
    const double here = design.at(ix, iy), ahead = design.at(ix + dx, iy + dy) - here,
                 behind = here - design.at(ix - dx, iy - dy);
    if (std::abs(ahead - behind) > kBend * std::max(std::abs(ahead), std::abs(behind)))
      return std::nullopt;
    square += 0.25 * (ahead + behind) * (ahead + behind);
  }
  return std::sqrt(square) / cell;
}

/// Sums of a comparison while its columns are visited.
struct ShapeSums {
  double columns = 0, to_do = 0, covered = 0, volume = 0, done = 0;
  double over = 0, under = 0;

  /// Adds a column with these heights at the start, now and in the design [m].
  void add(double start, double now, double wanted) {
    ++columns;
    const double depth = start - wanted, error = now - wanted;
    over += error < 0 ? error * error : 0;
    under += error > 0 ? error * error : 0;
    if (depth == 0) return;
    ++to_do;
    covered += (depth > 0 ? error : -error) <= kCovered ? 1 : 0;
    volume += std::abs(depth);
    // A column counts at most as far as it was to go.
    done += std::clamp((depth > 0 ? start - now : now - start), 0.0, std::abs(depth));
  }
};

}  // namespace

bool has_design(const heightfield::DesignSurface& design, int ix, int iy) {
  const heightfield::CellRect& r = design.rect;
  return ix >= r.x0 && ix < r.x1 && iy >= r.y0 && iy < r.y1 && !std::isnan(design.at(ix, iy));
}

void add_volumes(const heightfield::Terrain& surface, const heightfield::CellRect& rect,
                 const heightfield::DesignSurface* design, AreaScore& inside, AreaScore& outside) {
  const double square = surface.cell() * surface.cell();
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const double rise = surface.height(ix, iy) - surface.start_height(ix, iy);
      AreaScore& area = design != nullptr && has_design(*design, ix, iy) ? inside : outside;
      (rise < 0 ? area.cut : area.fill) += std::abs(rise) * square;
    }
}

ShapeScore measure_shape(const heightfield::Terrain& surface,
                         const heightfield::DesignSurface& design) {
  ShapeScore out;
  const heightfield::DesignComparison volumes = against_design(surface, design);
  out.area = volumes.area;
  out.design_cut = volumes.design_cut;
  out.design_fill = volumes.design_fill;
  ShapeSums sums;
  Regression sides;
  const double square = surface.cell() * surface.cell();
  for (int iy = design.rect.y0; iy < design.rect.y1; ++iy)
    for (int ix = design.rect.x0; ix < design.rect.x1; ++ix) {
      if (!has_design(design, ix, iy)) continue;
      const double wanted = design.at(ix, iy), start = surface.start_height(ix, iy),
                   now = surface.height(ix, iy);
      sums.add(start, now, wanted);
      const double depth = start - wanted;
      out.cut_area += depth > 0 ? square : 0;
      out.over_max = std::max(out.over_max, wanted - now);
      out.under_max = std::max(out.under_max, now - wanted);
      const std::optional<double> steep = steepness(design, ix, iy, surface.cell());
      if (steep && *steep > kLeastSlope && *steep < kMostSlope && std::abs(depth) > kSideDepth)
        sides.add(wanted, now, *steep);
    }
  if (sums.columns == 0) return out;
  out.over_rms = std::sqrt(sums.over / sums.columns);
  out.under_rms = std::sqrt(sums.under / sums.columns);
  out.rms = std::sqrt((sums.over + sums.under) / sums.columns);
  out.completion = sums.volume > 0 ? sums.done / sums.volume : 0;
  out.coverage = sums.to_do > 0 ? sums.covered / sums.to_do : 0;
  const double wanted = out.design_cut + out.design_fill;
  const double made =
      out.design_cut >= out.design_fill ? volumes.cut - volumes.fill : volumes.fill - volumes.cut;
  const double net = std::abs(out.design_cut - out.design_fill);
  out.volume_error = wanted > 0 ? (made - net) / wanted : 0;
  if (const std::optional<double> rate = sides.rate()) {
    const double steep = sides.slope / sides.n;
    out.design_batter = std::atan(steep);
    out.batter = std::atan(*rate * steep);
  }
  return out;
}

}  // namespace navvy::record
