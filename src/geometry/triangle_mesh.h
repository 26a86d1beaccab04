// SPDX-License-Identifier: Apache-2.0
// Triangle meshes, which are used for shells, visuals, collision shapes and sensor targets.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::geometry {

/// Appearance of a surface, as in a material of a Wavefront OBJ file. Colors are red, green and
/// blue from 0 to 1.
struct MeshMaterial {
  std::string name;                            ///< name of the material in the file
  std::array<float, 3> diffuse{}, specular{};  ///< diffuse and specular color
  float shininess = 0;                         ///< exponent of the specular highlight, 0 to 1000
  float opacity = 1;                           ///< 1: opaque, 0: invisible
};

/// Triangles with shared vertices, in a frame that the owner of the mesh defines.
///
/// The front of a triangle is the side from which its corners appear in counter-clockwise order;
/// its normal points to that side. The fronts of a closed body face outwards. Nothing else is
/// guaranteed: a mesh read from a file may be open, folded or empty. Use `require_valid` below and
/// `is_solid` in geometry/topology.h to check more.
struct TriangleMesh {
  std::vector<Vec3> vertices;                 ///< positions of the vertices [m]
  std::vector<std::array<int, 3>> triangles;  ///< three indices into `vertices` per triangle
  /// Materials in the order of the file, including unused ones.
  std::vector<MeshMaterial> materials;
  /// Index into `materials` for each triangle, -1: none. The list is empty if no triangle has a
  /// material.
  std::vector<int> material_of;

  /// Returns the position of corner i (0, 1 or 2) of triangle t [m]. Indices are not checked.
  const Vec3& corner(std::size_t t, std::size_t i) const {
    return vertices[static_cast<std::size_t>(triangles[t][i])];
  }
  /// Returns a vector along the normal of triangle t whose length is twice the triangle's area
  /// [m2].
  Vec3 area_vector(std::size_t t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  }
};

/// Axis-aligned box.
struct Box {
  /// Corners with the lowest and the highest coordinates [m].
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// Returns the smallest box that contains all vertices, including those that no triangle uses. For
/// a mesh without vertices the box is a point at the origin.
Box bounds(const TriangleMesh& mesh);

/// Checks the conditions that all functions of this module assume: vertices are finite, indices
/// refer to existing vertices and materials, and either all triangles or none have an entry in
/// `material_of`.
/// @throws InputError with the name of the mesh (`name`), the vertex or triangle, and the rule
void require_valid(const TriangleMesh& mesh, const std::string& name);

/// Returns the mesh with all vertices at exactly the same position merged into the first of them,
/// so that faces which a file lists with separate vertices become neighbours. Indices in the mesh
/// must be valid.
TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace navvy::geometry
