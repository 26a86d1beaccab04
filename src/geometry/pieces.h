// SPDX-License-Identifier: Apache-2.0
// Meshes cut into pieces of bounded size.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Longest edge of the pieces that the solver cuts shells into [cells]. Shorter pieces fit the zone
/// near a shell more tightly, longer ones cost fewer look-ups.
inline constexpr double kShellPieceCells = 3;

/// Part of a triangle.
struct MeshPiece {
  /// Corners [m].
  std::array<Vec3, 3> corner;
  /// Index of the triangle in the mesh.
  int triangle;
};

/// Halves triangles at their longest edge until no edge exceeds `longest` [m], in the order of the
/// triangles. The number of pieces grows with the area over the square of `longest`: call
/// `count_pieces` first for meshes from users.
std::vector<MeshPiece> cut_to_pieces(const TriangleMesh& mesh, double longest);

/// Counts the pieces that cut_to_pieces would return. Counting stops with the first piece beyond
/// `most`, which bounds the cost.
std::size_t count_pieces(const TriangleMesh& mesh, double longest, std::size_t most);

}  // namespace navvy::geometry
