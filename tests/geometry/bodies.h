// SPDX-License-Identifier: Apache-2.0
// Meshes with closed forms.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Returns a box with outward faces from `low` [m], with the given edges.
inline TriangleMesh make_box(const Vec3& low, const Vec3& edges) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(low + Vec3(k & 1, (k >> 1) & 1, k >> 2).cwiseProduct(edges));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Returns the tetrahedron of the origin and a step along each axis.
inline TriangleMesh make_tetrahedron(double a, double b, double c) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// Returns an octahedron with each triangle split into four `levels` times and its corners moved to
/// the ellipsoid.
inline TriangleMesh make_ellipsoid(const Vec3& axes, int levels) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> halves;
    const auto half = [&](int a, int b) {
      const auto [at, is_new] =
          halves.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (is_new)
        mesh.vertices.push_back((mesh.vertices[static_cast<std::size_t>(a)] +
                                 mesh.vertices[static_cast<std::size_t>(b)])
                                    .normalized());
      return at->second;
    };
    std::vector<std::array<int, 3>> fine;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = half(a, b), bc = half(b, c), ca = half(c, a);
      fine.insert(fine.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(fine);
  }
  for (Vec3& v : mesh.vertices) v = v.cwiseProduct(axes);
  return mesh;
}

}  // namespace navvy::geometry
