// SPDX-License-Identifier: Apache-2.0
#include "geometry/pieces.h"

namespace navvy::geometry {
namespace {

/// Passes each piece to `take` until that returns false. Depth first, so that few pieces are open
/// at a time.
template <class Take>
void each_piece(const TriangleMesh& mesh, double longest, const Take& take) {
  std::vector<MeshPiece> open;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    open.push_back(
        {{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}, static_cast<int>(t)});
    while (!open.empty()) {
      const MeshPiece piece = open.back();
      open.pop_back();
      std::size_t worst = 0;
      double length = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double l = (piece.corner[(i + 1) % 3] - piece.corner[i]).norm();
        if (l > length) {
          length = l;
          worst = i;
        }
      }
      if (length <= longest) {
        if (!take(piece)) return;
        continue;
      }
      // Halves the longest edge.
      const Vec3 a = piece.corner[worst], b = piece.corner[(worst + 1) % 3],
                 c = piece.corner[(worst + 2) % 3];
      const Vec3 middle = 0.5 * (a + b);
      open.push_back({{middle, b, c}, piece.triangle});
      open.push_back({{a, middle, c}, piece.triangle});
    }
  }
}

}  // namespace

std::vector<MeshPiece> cut_to_pieces(const TriangleMesh& mesh, double longest) {
  std::vector<MeshPiece> pieces;
  each_piece(mesh, longest, [&](const MeshPiece& piece) {
    pieces.push_back(piece);
    return true;
  });
  return pieces;
}

std::size_t count_pieces(const TriangleMesh& mesh, double longest, std::size_t most) {
  std::size_t count = 0;
  each_piece(mesh, longest, [&](const MeshPiece&) { return ++count <= most; });
  return count;
}

}  // namespace navvy::geometry
