// SPDX-License-Identifier: Apache-2.0
#include "geometry/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace navvy::geometry {
namespace {

constexpr int kFinest = 256;      // cubes along the longest side of the first lattice
constexpr double kCoarser = 0.7;  // cubes along a side / those of the lattice before

/// Returns the mesh with one vertex per cube of the lattice.
TriangleMesh clustered(const TriangleMesh& mesh, const Vec3& low, double edge) {
  TriangleMesh out;
  out.materials = mesh.materials;
  std::map<std::array<int, 3>, int> cubes;
  std::vector<int> cube_of, count;
  cube_of.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) {
    const Vec3 at = (p - low) / edge;
    const std::array<int, 3> cube{static_cast<int>(at.x()), static_cast<int>(at.y()),
                                  static_cast<int>(at.z())};
    const auto [found, added] = cubes.try_emplace(cube, static_cast<int>(out.vertices.size()));
    if (added) {
      out.vertices.push_back(Vec3::Zero());
      count.push_back(0);
    }
    const auto i = static_cast<std::size_t>(found->second);
    out.vertices[i] += p;
    ++count[i];
    cube_of.push_back(found->second);
  }
  for (std::size_t i = 0; i < out.vertices.size(); ++i) out.vertices[i] /= count[i];
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = cube_of[static_cast<std::size_t>(mesh.triangles[t][k])];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    out.triangles.push_back(corners);
    if (!mesh.material_of.empty()) out.material_of.push_back(mesh.material_of[t]);
  }
  return out;
}

}  // namespace

TriangleMesh simplified(const TriangleMesh& mesh, std::size_t most) {
  if (mesh.triangles.size() <= most) return mesh;
  const Box box = bounds(mesh);
  const double longest = (box.high - box.low).maxCoeff();
  TriangleMesh out = mesh;
  for (double cubes = kFinest; cubes >= 1 && out.triangles.size() > most; cubes *= kCoarser)
    out = clustered(mesh, box.low, longest > 0 ? longest / cubes : 1);
  return out;
}

}  // namespace navvy::geometry
