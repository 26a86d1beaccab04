// SPDX-License-Identifier: Apache-2.0
// Meshes cut to pieces of a bounded size.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Longest edge of the pieces that the solver cuts shells to [cells]: shorter ones fit the zone
/// near a shell tighter, longer ones cost fewer look-ups.
inline constexpr double kShellPieceCells = 3;

/// A part of a triangle.
struct MeshPiece {
  std::array<Vec3, 3> corner;
  int triangle;  ///< of the mesh
};

/// Halves triangles at their longest edge until no edge is longer than `longest` [m], in the
/// triangles' order. The pieces' number follows from the area over the square of `longest`: ask
/// `count_pieces` first of meshes that are not one's own.
std::vector<MeshPiece> cut_to_pieces(const TriangleMesh& mesh, double longest);

/// How many pieces that gives. Counting ends with the first beyond `most`, so it costs no more than
/// that.
std::size_t count_pieces(const TriangleMesh& mesh, double longest, std::size_t most);

}  // namespace navvy::geometry
