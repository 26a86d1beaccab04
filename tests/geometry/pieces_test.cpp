// SPDX-License-Identifier: Apache-2.0
#include "geometry/pieces.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace navvy::geometry {
namespace {

TriangleMesh right_triangle(double leg) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {leg, 0, 0}, {0, leg, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(Pieces, CoverTheTriangleWithinTheRequestedLength) {
  const TriangleMesh mesh = right_triangle(2);
  const std::vector<MeshPiece> pieces = cut_to_pieces(mesh, 0.3);
  double area = 0;
  for (const MeshPiece& piece : pieces) {
    EXPECT_EQ(piece.triangle, 0);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LE((piece.corner[(i + 1) % 3] - piece.corner[i]).norm(), 0.3);
    area +=
        0.5 * (piece.corner[1] - piece.corner[0]).cross(piece.corner[2] - piece.corner[0]).norm();
  }
  EXPECT_NEAR(area, 2, 1e-12);
  EXPECT_EQ(count_pieces(mesh, 0.3, 1'000'000), pieces.size());
}

TEST(Pieces, CountingStopsAtTheLimit) {
  // A full count would be some 10^13 pieces.
  EXPECT_EQ(count_pieces(right_triangle(2000), 1e-3, 5000), 5001u);
  EXPECT_EQ(count_pieces(right_triangle(0.1), 0.3, 0), 1u);
}

}  // namespace
}  // namespace navvy::geometry
