// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/held_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/random.h"
#include "geometry/bucket_shape.h"
#include "soil/rig.h"

namespace navvy::soil {
namespace {

scene::Shell bucket() {
  scene::Shell out;
  static_cast<geometry::TriangleMesh&>(out) = geometry::bucket_shell({1.05, 1.3, 0.03, 0.05}, 1.0);
  return out;
}

/// Shell of two parts that are not joined, one with its front outside.
scene::Shell two_parts() {
  scene::Shell out = rig::open_box(1.0, 0.8, 0.6);
  const scene::Shell other = lab::closed_box(0.2, 0.2, 0.2);
  const int first = static_cast<int>(out.vertices.size());
  for (const Vec3& v : other.vertices) out.vertices.push_back(v + Vec3(0.1, 0.05, 0.4));
  for (const auto& t : other.triangles)
    out.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return out;
}

/// The same triangles without common corners, as in files that list each triangle alone. Plates
/// that meet at an edge then have different normals there.
scene::Shell torn(const scene::Shell& shell) {
  scene::Shell out = shell;
  out.vertices.clear();
  for (auto& triangle : out.triangles)
    for (int& v : triangle) {
      out.vertices.push_back(shell.vertices[static_cast<std::size_t>(v)]);
      v = static_cast<int>(out.vertices.size()) - 1;
    }
  return out;
}

/// Compares a space with its geometry in and around it, close to the plates, and on them; returns
/// the number of points that are held.
int compare(const scene::Shell& shell) {
  const ShellGeometry geometry(shell, 0.1);
  HeldSpace space(geometry);
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& p : geometry.hull_points()) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Random random(7);
  int held = 0;
  const auto look = [&](const Vec3& p) {
    const bool wanted = geometry.holds(p);
    EXPECT_EQ(space.holds(p), wanted) << p.transpose();
    held += wanted ? 1 : 0;
  };
  for (int i = 0; i < 30000; ++i) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = random.uniform(low[a] - 0.1, high[a] + 0.1);
    look(p);
  }
  for (const ShellGeometry::Triangle& t : geometry.triangles())
    for (int i = 0; i < 300; ++i) {
      const double u = random.uniform(-0.1, 1.1), v = random.uniform(-0.1, 1.1);
      const double distance = std::pow(10.0, random.uniform(-6, -1)) * (i % 2 == 0 ? 1 : -1);
      look(t.corner[0] + u * (t.corner[1] - t.corner[0]) + v * (t.corner[2] - t.corner[0]) +
           distance * t.normal);
    }
  for (const ShellGeometry::Triangle& t : geometry.triangles())
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = t.corner[i], &b = t.corner[(i + 1) % 3];
      for (const double share : {0.0, 0.25, 0.5, 1.0})
        for (const double off : {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-7})
          look(a + share * (b - a) + off * Vec3(1, -0.7, 0.4));
      look(t.centre);
    }
  // Points of the raised mouth, which are corners of the hull.
  for (const Vec3& p : geometry.hull_points()) look(p), look(p + Vec3(0, 0, -1e-12));
  return held;
}

TEST(HeldSpace, HoldsWhatTheShellHolds) {
  EXPECT_GT(compare(bucket()), 5000);
  EXPECT_GT(compare(rig::open_box(1.0, 0.8, 0.6)), 5000);
  EXPECT_GT(compare(two_parts()), 5000);
  EXPECT_GT(compare(torn(bucket())), 5000);
  // A closed body holds nothing, or all that is inside it.
  scene::Shell box = lab::closed_box(1.0, 0.8, 0.6);
  compare(box);
  for (auto& triangle : box.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_GT(compare(box), 5000);
}

TEST(HeldSpace, HoldsNoPointThatIsNotFinite) {
  const ShellGeometry geometry(bucket(), 0.1);
  HeldSpace space(geometry);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(space.holds(Vec3(nan, nan, nan)));
  EXPECT_FALSE(space.holds(Vec3(std::numeric_limits<double>::infinity(), 0, 0)));
}

}  // namespace
}  // namespace navvy::soil
