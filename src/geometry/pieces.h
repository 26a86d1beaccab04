// SPDX-License-Identifier: Apache-2.0
// Divides meshes into pieces of limited size.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Maximum edge length, in soil cells, of the pieces into which the solver divides shells. With
/// shorter pieces, the zone of cells near a shell fits more tightly; with longer pieces, there are
/// fewer pieces to look up.
inline constexpr double kShellPieceCells = 3;

/// A triangle that is part of a triangle of a mesh.
struct MeshPiece {
  std::array<Vec3, 3> corner;  ///< corners [m]
  int triangle;                ///< index in the mesh of the triangle to which the piece belongs
};

/// Returns the mesh as pieces in the order of its triangles. A piece is halved at its longest edge
/// until no edge is longer than `longest` [m]. The number of pieces is proportional to area /
/// longest^2; for meshes from users, call `count_pieces` first.
std::vector<MeshPiece> cut_to_pieces(const TriangleMesh& mesh, double longest);

/// Returns the number of pieces that `cut_to_pieces` would return. To limit the cost, counting
/// stops at `most` + 1.
std::size_t count_pieces(const TriangleMesh& mesh, double longest, std::size_t most);

}  // namespace navvy::geometry
