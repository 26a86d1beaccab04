// SPDX-License-Identifier: Apache-2.0
// Triangle meshes of shells, visuals, collision shapes and sensor targets.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::geometry {

/// Appearance of a surface, like a Wavefront material. Colours are red, green, blue in 0..1.
struct MeshMaterial {
  std::string name;
  std::array<float, 3> diffuse{}, specular{};
  /// Exponent of the highlight, 0..1000.
  float shininess = 0;
  /// 1: opaque, 0: invisible.
  float opacity = 1;
};

/// Triangles over shared vertices, in a frame that the owner defines.
///
/// The front of a triangle is the side from which its corners run counter-clockwise; its normal
/// points there. The front of a closed body is its outside. No more is guaranteed: a mesh read from
/// a file may be open, folded or empty. Use `require_valid` here and `is_solid` in
/// geometry/topology.h to check more.
struct TriangleMesh {
  /// Vertices [m].
  std::vector<Vec3> vertices;
  /// Triangles, each with three indices into `vertices`.
  std::vector<std::array<int, 3>> triangles;
  /// Materials in the file's order, including unused ones.
  std::vector<MeshMaterial> materials;
  /// Index of each triangle's material, -1 for none. Empty if no triangle has one.
  std::vector<int> material_of;

  /// Returns corner i (0, 1, 2) of triangle t [m]. Indices are not checked.
  const Vec3& corner(std::size_t t, std::size_t i) const {
    return vertices[static_cast<std::size_t>(triangles[t][i])];
  }
  /// Returns the area vector of triangle t [m2]: along its normal, twice its area long.
  Vec3 area_vector(std::size_t t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  }
};

/// Axis-aligned box [m]; `low` has the least coordinates.
struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// Returns the smallest box around all vertices, used or not; a point at the origin for a mesh
/// without vertices.
Box bounds(const TriangleMesh& mesh);

/// Checks what all functions of this module assume: finite vertices, indices of existing vertices,
/// and a material for all triangles or for none.
/// @throws InputError naming `name`, the vertex or triangle, and the rule.
void require_valid(const TriangleMesh& mesh, const std::string& name);

/// Returns the same triangles with vertices at exactly the same place merged, so that faces that a
/// file keeps apart become neighbours. The first vertex at a place is kept. Indices must be valid.
TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace navvy::geometry
