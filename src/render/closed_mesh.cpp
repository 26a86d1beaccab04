// SPDX-License-Identifier: Apache-2.0
#include "render/closed_mesh.h"

#include "geometry/topology.h"

namespace navvy::render {

bool is_solid(const std::vector<Vec3f>& points, const std::vector<std::int32_t>& indices) {
  geometry::TriangleMesh mesh;
  for (const Vec3f& p : points) mesh.vertices.push_back(p.cast<double>());
  // Splits faces into fans: diagonals are traversed once in each direction, so the outline decides
  // as before.
  for (std::size_t first = 0, i = 0; i < indices.size(); ++i) {
    if (indices[i] >= 0) continue;
    for (std::size_t k = first + 2; k < i; ++k)
      mesh.triangles.push_back({indices[first], indices[k - 1], indices[k]});
    first = i + 1;
  }
  return geometry::is_solid(mesh);
}

}  // namespace navvy::render
