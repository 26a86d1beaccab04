// SPDX-License-Identifier: Apache-2.0
// Triangle meshes: what a shell, a visual, a collision shape and a sensor's target are made of.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::geometry {

/// How a surface looks, as a Wavefront material says it. Colours are red, green, blue in 0..1.
struct MeshMaterial {
  std::string name;
  std::array<float, 3> diffuse{}, specular{};
  float shininess = 0;  ///< exponent of the highlight, 0..1000
  float opacity = 1;    ///< 1 solid, 0 not to be seen
};

/// Triangles over shared vertices, in a frame that the owner names.
///
/// A triangle's front is the side from which its corners run counter-clockwise; its normal points
/// there. The front of a closed body is its outside. Nothing is promised beyond that: a mesh read
/// from a file may be open, folded or empty, and whoever needs more asks `require_valid` here and
/// `inspect` in geometry/topology.h.
struct TriangleMesh {
  std::vector<Vec3> vertices;                 ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< three indices into `vertices` each
  /// In the file's order, also those that no triangle has.
  std::vector<MeshMaterial> materials;
  /// One a triangle, -1 none; empty when no triangle has any.
  std::vector<int> material_of;

  /// Corner i (0, 1, 2) of triangle t [m]. Indices are not checked.
  const Vec3& corner(std::size_t t, std::size_t i) const {
    return vertices[static_cast<std::size_t>(triangles[t][i])];
  }
  /// Along the normal of triangle t, twice its area long [m2].
  Vec3 area_vector(std::size_t t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  }
};

/// An upright box [m]; `low` is least in every coordinate.
struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// The smallest box round all vertices, used or not; a point at the origin for a mesh without any.
Box bounds(const TriangleMesh& mesh);

/// Checks what every function of this room takes for granted: finite vertices, indices that name a
/// vertex, and a material for every triangle or for none.
/// @throws InputError naming `name`, the vertex or triangle and the rule.
void require_valid(const TriangleMesh& mesh, const std::string& name);

/// The same triangles with vertices at exactly the same place united, so that faces which a file
/// keeps apart are neighbours. The first vertex at a place stays. Indices must be valid.
TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace navvy::geometry
