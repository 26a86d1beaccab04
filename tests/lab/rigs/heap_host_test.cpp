// SPDX-License-Identifier: Apache-2.0
// Measurements of a pile, on piles of known volume and slope.
#include "lab/rigs/heap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/random.h"

namespace navvy::lab {
namespace {

constexpr double kCell = 0.1;

/// Returns eight particles per cell on a lattice, each displaced by up to `shake` of the spacing,
/// where `inside` allows.
template <class F>
std::vector<Vec3> lattice(const Vec3& size, double shake, const F& inside) {
  Random random(3);
  std::vector<Vec3> out;
  const double h = kCell / 2;
  for (double z = h / 2; z < size.z(); z += h)
    for (double y = h / 2; y < size.y(); y += h)
      for (double x = h / 2; x < size.x(); x += h) {
        Vec3 p(x, y, z);
        if (!inside(p)) continue;
        for (int a = 0; a < 3; ++a) p[a] += shake * h * random.uniform(-1, 1);
        out.push_back(p);
      }
  return out;
}

double mean_height(const HeapSurface& s, const Vec2& size) {
  double sum = 0, count = 0;
  for (int iy = 0; iy < s.ny; ++iy)
    for (int ix = 0; ix < s.nx; ++ix) {
      const Vec2 p = s.middle(ix, iy);
      if ((p - size / 2).cwiseAbs().maxCoeff() > size.x() / 2 - 2 * kCell) continue;
      sum += s.at(ix, iy);
      count += 1;
    }
  return sum / count;
}

TEST(HeapSurface, OfABlockIsAQuarterCellAboveItsGrains) {
  const Vec3 size(1, 1, 0.6);
  const auto all = [](const Vec3&) { return true; };
  const double exact = mean_height(surface_of(lattice(size, 0, all), kCell, 0), size.head<2>());
  std::printf("[ VALUE    ] bias of the surface over a lattice: %.3f cells\n",
              (exact - 0.6) / kCell);
  // A ball of half a cell sinks by 0.15 cells between four particles of a lattice, by a third of it
  // on average.
  EXPECT_NEAR(exact, 0.6, 0.07 * kCell);
  // Displaced particles: the ball rolls on the highest of them, and falls between them as often.
  const double shaken = mean_height(surface_of(lattice(size, 0.5, all), kCell, 0), size.head<2>());
  std::printf("[ VALUE    ] bias of the surface over shaken grains: %.3f cells\n",
              (shaken - 0.6) / kCell);
  EXPECT_NEAR(shaken, 0.6, 0.05 * kCell);
  // Randomly placed particles.
  Random random(5);
  std::vector<Vec3> strewn;
  strewn.reserve(8 * 600);
  for (int i = 0; i < 8 * 600; ++i)
    strewn.push_back(Vec3(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(size));
  const double loose = mean_height(surface_of(strewn, kCell, 0), size.head<2>());
  std::printf("[ VALUE    ] bias of the surface over strewn grains: %.3f cells\n",
              (loose - 0.6) / kCell);
  EXPECT_NEAR(loose, 0.6, 0.05 * kCell);
}

TEST(HeapSurface, FlankOfAHeapHasItsAngle) {
  const double slope = std::tan(radians(31));
  const auto wedge = [&](const Vec3& p) { return p.z() < slope * (2 - std::abs(p.x() - 2)); };
  const HeapSurface flat = surface_of(lattice(Vec3(4, 0.5, 1.3), 0.3, wedge), kCell, 0);
  EXPECT_NEAR(degrees(flank_angle(flat, Vec2(2, 0.25), false, kCell)), 31, 0.7);
  const auto cone = [&](const Vec3& p) {
    return p.z() < slope * (2 - (p.head<2>() - Vec2(2, 2)).norm());
  };
  const HeapSurface round = surface_of(lattice(Vec3(4, 4, 1.3), 0.3, cone), kCell, 0);
  EXPECT_NEAR(degrees(flank_angle(round, Vec2(2, 2), true, kCell)), 31, 0.7);
  const double exact = kPi / 3 * 4 * slope * 2;
  std::printf("[ VALUE    ] volume of a cone of grains / exact: %.4f\n", round.volume() / exact);
  EXPECT_NEAR(round.volume(), exact, 0.05 * exact);
}

TEST(Percentile, IsTheValueWithTheGivenShareBelow) {
  EXPECT_EQ(percentile({5, 1, 3, 2, 4}, 0.5), 3);
  EXPECT_EQ(percentile({5, 1, 3, 2, 4}, 1), 5);
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
}

}  // namespace
}  // namespace navvy::lab
