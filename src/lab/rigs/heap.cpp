// SPDX-License-Identifier: Apache-2.0
#include "lab/rigs/heap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace navvy::lab {
namespace {

/// Cell of a separate grid, anchored at W's origin.
using Cell = std::array<int, 3>;

Cell cell_of(const Vec3& p, double cell) {
  Cell out;
  for (std::size_t a = 0; a < 3; ++a)
    out[a] = static_cast<int>(std::floor(p[static_cast<int>(a)] / cell));
  return out;
}

/// Heights of a ball over its centre, on the surface's grid.
struct Ball {
  // In columns, from the ball's centre.
  int reach = 0;
  /// (2 reach + 1)^2; negative outside the ball.
  std::vector<double> height;
  Ball(double radius, double spacing) : reach(static_cast<int>(std::ceil(radius / spacing))) {
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const double rest = radius * radius - spacing * spacing * (i * i + j * j);
        height.push_back(rest >= 0 ? std::sqrt(rest) : -1);
      }
  }
  /// Calls f(i, j, height) for every column under the ball.
  template <class F>
  void each(const F& f) const {
    std::size_t at = 0;
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i, ++at)
        if (height[at] >= 0) f(i, j, height[at]);
  }
};

/// Dilates: the top of a ball around each particle.
void dilate(HeapSurface& s, const std::vector<Vec3>& positions, double radius) {
  const int reach = static_cast<int>(std::ceil(radius / s.spacing));
  for (const Vec3& p : positions) {
    const int cx = static_cast<int>(std::lround((p.x() - s.origin.x()) / s.spacing)),
              cy = static_cast<int>(std::lround((p.y() - s.origin.y()) / s.spacing));
    for (int iy = std::max(0, cy - reach); iy <= std::min(s.ny - 1, cy + reach); ++iy)
      for (int ix = std::max(0, cx - reach); ix <= std::min(s.nx - 1, cx + reach); ++ix) {
        // Exact distance from the column's centre: particles between two columns count for both.
        const double rest = radius * radius - (s.middle(ix, iy) - p.head<2>()).squaredNorm();
        if (rest < 0) continue;
        double& top = s.top[static_cast<std::size_t>(ix + s.nx * iy)];
        top = std::max(top, p.z() + std::sqrt(rest));
      }
  }
}

/// Erodes: the lowest position to which a ball can be pushed down under the surface. Fills what no
/// ball of this radius can enter.
void erode(HeapSurface& s, double radius) {
  const Ball ball(radius, s.spacing);
  std::vector<double> out(s.top.size());
  for (int iy = 0; iy < s.ny; ++iy)
    for (int ix = 0; ix < s.nx; ++ix) {
      double least = s.at(ix, iy) - radius;
      ball.each([&](int i, int j, double height) {
        const int x = ix + i, y = iy + j;
        // The margin around the pile is wider than the ball: nothing is lost at the edge.
        if (x < 0 || y < 0 || x >= s.nx || y >= s.ny) return;
        least = std::min(least, s.at(x, y) - height);
      });
      out[static_cast<std::size_t>(ix + s.nx * iy)] = std::max(s.floor, least);
    }
  s.top.swap(out);
}

}  // namespace

std::vector<Vec3> in_contact(const Site& site, const std::vector<soil::Particle>& particles,
                             int neighbours) {
  // Two passes: count by cell, then look around each cell that has any.
  std::vector<Vec3> positions, out;
  std::map<Cell, int> count;
  for (const soil::Particle& p : particles) {
    positions.push_back(site.position(p));
    ++count[cell_of(positions.back(), site.cell())];
  }
  // By cell, not by pairs: linear in the particles, and good enough to separate a heap from a
  // spray.
  std::map<Cell, bool> touching;
  for (const auto& [cell, here] : count) {
    // Without the particle itself.
    int around = -1;
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const auto found = count.find({cell[0] + i, cell[1] + j, cell[2] + k});
          if (found != count.end()) around += found->second;
        }
    touching[cell] = around >= neighbours;
  }
  for (const Vec3& p : positions)
    if (touching[cell_of(p, site.cell())]) out.push_back(p);
  return out;
}

/// Nearest column; p must be a particle of the pile, which lies well inside the surface's
/// rectangle.
double HeapSurface::over(const Vec3& p) const {
  return at(static_cast<int>(std::lround((p.x() - origin.x()) / spacing)),
            static_cast<int>(std::lround((p.y() - origin.y()) / spacing)));
}

double HeapSurface::volume() const {
  double sum = 0;
  for (const double z : top) sum += z - floor;
  // Columns have equal areas: a sum is the integral.
  return sum * spacing * spacing;
}

double HeapSurface::highest() const {
  return top.empty() ? floor : *std::max_element(top.begin(), top.end());
}

HeapSurface surface_of(const std::vector<Vec3>& positions, double cell, double floor) {
  HeapSurface s;
  s.spacing = cell / 4;
  s.floor = floor;
  if (positions.empty()) return s;
  Vec2 low = positions.front().head<2>(), high = low;
  for (const Vec3& p : positions) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  // Wide enough for both balls.
  low -= Vec2::Constant(1.5 * cell);
  high += Vec2::Constant(1.5 * cell);
  // Columns on a fixed lattice: the same pile gives the same surface wherever its outermost
  // particle lies.
  s.origin = s.spacing * (low / s.spacing).array().floor().matrix();
  s.nx = static_cast<int>((high.x() - s.origin.x()) / s.spacing) + 1;
  s.ny = static_cast<int>((high.y() - s.origin.y()) / s.spacing) + 1;
  s.top.assign(static_cast<std::size_t>(s.nx) * static_cast<std::size_t>(s.ny), floor);
  // The larger ball dilates: the difference is the quarter of a cell by which a pile extends above
  // its topmost particles.
  dilate(s, positions, 0.75 * cell);
  erode(s, 0.5 * cell);
  return s;
}

Line fit_line(const std::vector<double>& x, const std::vector<double>& z) {
  double sx = 0, sz = 0, sxx = 0, sxz = 0;
  const double n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i], sz += z[i];
    sxx += x[i] * x[i], sxz += x[i] * z[i];
  }
  // Normal equations; the values are at most a few tens of metres or seconds, so that nothing
  // cancels.
  Line out;
  out.b = (n * sxz - sx * sz) / (n * sxx - sx * sx);
  out.a = (sz - out.b * sx) / n;
  return out;
}

std::vector<std::pair<double, double>> flank_profile(const HeapSurface& surface, const Vec2& axis,
                                                     bool axisymmetric, double cell) {
  // Sum and count by ring.
  std::map<int, std::pair<double, int>> rings;
  // The middle third between the plates: half of it on either side.
  const double across = surface.spacing * surface.ny / 6;
  for (int iy = 0; iy < surface.ny; ++iy)
    for (int ix = 0; ix < surface.nx; ++ix) {
      // Both flanks of a plane heap fall into the same strips, which averages out a tilt.
      const Vec2 d = surface.middle(ix, iy) - axis;
      if (!axisymmetric && std::abs(d.y()) > across) continue;
      const double r = axisymmetric ? d.norm() : std::abs(d.x());
      auto& [sum, count] = rings[static_cast<int>(r / (0.5 * cell))];
      sum += surface.at(ix, iy) - surface.floor;
      ++count;
    }
  std::vector<std::pair<double, double>> out;
  out.reserve(rings.size());
  for (const auto& [ring, entry] : rings)
    out.emplace_back((ring + 0.5) * 0.5 * cell, entry.first / entry.second);
  return out;
}

// The line is fitted where a flank is straight: not at the rounded top, not in the thin toe.
double flank_angle(const HeapSurface& surface, const Vec2& axis, bool axisymmetric, double cell) {
  const auto profile = flank_profile(surface, axis, axisymmetric, cell);
  double highest = 0, shoulder = 0;
  for (const auto& [r, height] : profile) highest = std::max(highest, height);
  // A stream leaves a dip in the middle: the flank begins outside the last ring that is higher than
  // 80 %.
  for (const auto& [r, height] : profile)
    if (height > 0.8 * highest) shoulder = r;
  std::vector<double> x, z;
  for (const auto& [r, height] : profile) {
    // Below a fifth there are single particles that have run out.
    if (r <= shoulder || height < 0.2 * highest) continue;
    x.push_back(r);
    z.push_back(height);
  }
  return x.size() < 2 ? kNone : std::atan(-fit_line(x, z).b);
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return kNone;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  // The order of the others does not matter: linear time.
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

}  // namespace navvy::lab
