// SPDX-License-Identifier: Apache-2.0
#include "earthwork/pit_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/polygon.h"

namespace navvy::earthwork {

PitShape::PitShape(const scene::DesignArea& area, const control::SurfaceView& surface)
    : terrain_(surface.terrain()),
      polygon_(area.polygon),
      design_(heightfield::design_of_area(area, surface.terrain(), "")) {
  const Vec2 corner = polygon_.front();
  const Vec2i column = terrain_.column_at(corner.x(), corner.y());
  ground_ = terrain_.start_height(column.x(), column.y());
  lowest_ = rim_ = ground_;
  const heightfield::CellRect& r = design_.rect;
  for (int iy = r.y0; iy < r.y1; ++iy)
    for (int ix = r.x0; ix < r.x1; ++ix)
      if (const auto z = static_cast<double>(design_.at(ix, iy)); !std::isnan(z)) {
        rim_ = std::max(rim_, terrain_.start_height(ix, iy));
        lowest_ = std::min(lowest_, z);
      }
}

void PitShape::add_border(double width, double skin) {
  const int n = static_cast<int>(std::ceil(width / cell()));
  heightfield::DesignSurface wide;
  const heightfield::CellRect& r = design_.rect;
  wide.rect =
      heightfield::CellRect{r.x0 - n, r.y0 - n, r.x1 + n, r.y1 + n}.cut(terrain_.site_rect());
  for (int iy = wide.rect.y0; iy < wide.rect.y1; ++iy)
    for (int ix = wide.rect.x0; ix < wide.rect.x1; ++ix) {
      const Vec2 p = terrain_.origin() + cell() * Vec2(ix + 0.5, iy + 0.5);
      double z = floor(p);
      if (std::isnan(z) && is_near(p, width)) z = terrain_.start_height(ix, iy) + skin;
      wide.z.push_back(static_cast<float>(z));
    }
  design_ = std::move(wide);
}

void PitShape::cover_heap(double skin) {
  std::array<double, 4> corner{};
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const Vec2i at = terrain_.column_at(polygon_[i].x(), polygon_[i].y());
    corner[i] = terrain_.start_height(at.x(), at.y());
  }
  const Vec2 along = polygon_[1] - polygon_[0], across = polygon_[3] - polygon_[0];
  ground_ = rim_ = -std::numeric_limits<double>::infinity();
  lowest_ = -ground_;
  const heightfield::CellRect& r = design_.rect;
  std::size_t i = 0;
  for (int iy = r.y0; iy < r.y1; ++iy)
    for (int ix = r.x0; ix < r.x1; ++ix, ++i) {
      if (std::isnan(design_.z[i])) continue;
      const Vec2 p = terrain_.origin() + terrain_.cell() * Vec2(ix + 0.5, iy + 0.5) - polygon_[0];
      const double u = p.dot(along) / along.squaredNorm(), v = p.dot(across) / across.squaredNorm();
      const double z = (1 - v) * ((1 - u) * corner[0] + u * corner[1]) +
                       v * ((1 - u) * corner[3] + u * corner[2]) + skin;
      design_.z[i] = static_cast<float>(z);
      lowest_ = std::min(lowest_, z);
      ground_ = rim_ = std::max({rim_, z, terrain_.height(ix, iy)});
    }
}

double PitShape::floor(const Vec2& p) const {
  const Vec2i column = terrain_.column_at(p.x(), p.y());
  const heightfield::CellRect& r = design_.rect;
  if (column.x() < r.x0 || column.x() >= r.x1 || column.y() < r.y0 || column.y() >= r.y1)
    return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(design_.at(column.x(), column.y()));
}

std::vector<PitColumn> PitShape::columns() const {
  std::vector<PitColumn> out;
  const heightfield::CellRect& r = design_.rect;
  for (int iy = r.y0; iy < r.y1; ++iy)
    for (int ix = r.x0; ix < r.x1; ++ix) {
      const auto z = static_cast<double>(design_.at(ix, iy));
      if (std::isnan(z)) continue;
      out.push_back({terrain_.origin() + terrain_.cell() * Vec2(ix + 0.5, iy + 0.5), z,
                     terrain_.height(ix, iy)});
    }
  return out;
}

std::pair<double, double> PitShape::span(const Vec2& along) const {
  const double infinite = std::numeric_limits<double>::infinity();
  std::pair<double, double> out(infinite, -infinite);
  for (const PitColumn& one : columns()) {
    out.first = std::min(out.first, one.p.dot(along));
    out.second = std::max(out.second, one.p.dot(along));
  }
  return out;
}

double PitShape::width() const {
  const Vec2 longest = scene::longest_edge(polygon_).normalized();
  const auto [low, high] = span(Vec2(-longest.y(), longest.x()));
  return high - low;
}

control::JobVolume PitShape::volume() const {
  control::JobVolume out;
  double squares = 0;
  int columns = 0;
  const heightfield::CellRect& r = design_.rect;
  for (int iy = r.y0; iy < r.y1; ++iy)
    for (int ix = r.x0; ix < r.x1; ++ix) {
      const auto z = static_cast<double>(design_.at(ix, iy));
      if (std::isnan(z)) continue;
      const double start = std::max(0.0, terrain_.start_height(ix, iy) - z);
      out.design += start * column_area();
      // Soil that lies higher than the ground was is not part of the commanded volume.
      const double error = terrain_.height(ix, iy) - z;
      out.left += std::clamp(error, 0.0, start) * column_area();
      squares += error * error;
      ++columns;
    }
  if (columns > 0) out.rms = std::sqrt(squares / columns);
  return out;
}

bool PitShape::is_near(const Vec2& p, double range) const {
  const int n = static_cast<int>(std::ceil(range / cell()));
  for (int y = -n; y <= n; ++y)
    for (int x = -n; x <= n; ++x)
      if (std::hypot(x, y) * cell() <= range && !std::isnan(floor(p + cell() * Vec2(x, y))))
        return true;
  return false;
}

}  // namespace navvy::earthwork
