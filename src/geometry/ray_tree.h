// SPDX-License-Identifier: Apache-2.0
// First hit of a ray on a triangle mesh, found with a tree of boxes.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// First hit of a ray on a mesh, at origin + distance * unit direction.
struct RayHit {
  /// Index of the triangle in the mesh.
  int triangle = -1;
  /// Distance from the ray's origin [m].
  double distance = 0;
  /// Unit normal of the triangle's front, in the mesh's frame; the ray may come from behind.
  Vec3 normal = Vec3::Zero();
};

/// Triangle mesh prepared for ray queries. Immutable, so that several threads may query it.
///
/// A ray hits both sides of a triangle. Rays through an edge or a corner never pass between the
/// triangles that share it [Woop 2013]. Of hits at equal distance the triangle of lowest index
/// wins, so the result depends on the mesh alone and not on the tree. Triangles without area are
/// never hit. For rays on the ground use heightfield::Terrain::ray.
class RayTree {
 public:
  /// Builds the tree from a copy of the mesh: 120 bytes and half a microsecond per triangle.
  /// @throws InputError naming `name`, like `require_valid`.
  explicit RayTree(const TriangleMesh& mesh, const std::string& name = "mesh");

  /// Returns the first hit within `reach` [m], or nothing; takes half a microsecond for 10^5
  /// triangles. `origin` [m] and `direction` (any length above zero) are in the mesh's frame.
  /// @throws InputError if the origin or the direction is not finite, the direction has no length,
  /// or `reach` is NaN.
  std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction,
                                  double reach = std::numeric_limits<double>::infinity()) const;

  /// Returns the number of triangles.
  std::size_t size() const { return triangles_.size(); }

 private:
  /// Node of the tree. Children are referred to by index, so that the tree is copyable and movable.
  struct Node {
    Box box;
    /// First triangle of a leaf in `order_`, else the left child; the right child follows it.
    std::uint32_t first = 0;
    /// Number of triangles of a leaf, 0 for an inner node.
    std::uint32_t count = 0;
  };
  /// Splits a node at the median of the triangles' centres, recursively.
  void split(std::size_t node, std::uint32_t first, std::uint32_t last,
             const std::vector<Vec3>& centres);

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace navvy::geometry
