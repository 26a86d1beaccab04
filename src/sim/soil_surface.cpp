// SPDX-License-Identifier: Apache-2.0
#include "sim/soil_surface.h"

#include <algorithm>
#include <cmath>

#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

constexpr double kGap = 2.0;  // a particle this many cells above what lies below it is in the air

struct Grain {
  std::int64_t column;
  double z;       // W height [m]
  double volume;  // [m3]
};

}  // namespace

void SoilSurface::look() const {
  const heightfield::Ground& ground = world_.ground();
  const std::vector<scene::Soil>& soils = world_.description().soils;
  std::vector<Grain> grains;
  for (const soil::Particle& p : parts(world_).soil.particles()) {
    const auto [ix, iy] = parts(world_).soil.grid().column_of(p);
    if (!ground.contains(ix, iy)) continue;
    const double z = ground.datum() + ground.cell() * (p.block[2] * soil::kBlockCells + static_cast<double>(p.x[2]));
    grains.push_back({static_cast<std::int64_t>(iy) * ground.nx() + ix, z,
                      kilograms(p.mass) * static_cast<double>(p.j0) / soils[p.soil].bank_density});
  }
  std::sort(grains.begin(), grains.end(),
            [](const Grain& a, const Grain& b) { return a.column != b.column ? a.column < b.column : a.z < b.z; });
  tops_.clear();
  const double area = ground.cell() * ground.cell();
  for (std::size_t i = 0; i < grains.size();) {
    const std::int64_t column = grains[i].column;
    const int ix = static_cast<int>(column % ground.nx()), iy = static_cast<int>(column / ground.nx());
    double top = ground.height(ix, iy);
    for (; i < grains.size() && grains[i].column == column; ++i)
      if (grains[i].z < top + kGap * ground.cell()) top += grains[i].volume / area;
    tops_.emplace_back(column, top);
  }
  looked_ = true;
  seen_step_ = world_.steps();
}

double SoilSurface::column_top(int ix, int iy) const {
  const heightfield::Ground& ground = world_.ground();
  ix = std::clamp(ix, 0, ground.nx() - 1);
  iy = std::clamp(iy, 0, ground.ny() - 1);
  const std::int64_t key = static_cast<std::int64_t>(iy) * ground.nx() + ix;
  const auto it = std::lower_bound(tops_.begin(), tops_.end(), key,
                                   [](const auto& entry, std::int64_t wanted) { return entry.first < wanted; });
  return it != tops_.end() && it->first == key ? it->second : ground.height(ix, iy);
}

double SoilSurface::height(double x, double y) const {
  if (!looked_ || world_.steps() != seen_step_) look();
  const heightfield::Ground& ground = world_.ground();
  const double u = (x - ground.origin().x()) / ground.cell() - 0.5, v = (y - ground.origin().y()) / ground.cell() - 0.5;
  const int ix = static_cast<int>(std::floor(u)), iy = static_cast<int>(std::floor(v));
  const double a = u - ix, b = v - iy;
  return (1 - b) * ((1 - a) * column_top(ix, iy) + a * column_top(ix + 1, iy)) +
         b * ((1 - a) * column_top(ix, iy + 1) + a * column_top(ix + 1, iy + 1));
}

}  // namespace navvy::sim
