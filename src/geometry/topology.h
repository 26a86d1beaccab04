// SPDX-License-Identifier: Apache-2.0
// How the triangles of a mesh hang together: free edges, folds that disagree, bodies that enclose space.
#pragma once

#include <optional>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Two triangles that run along a shared edge in the same direction: their fronts disagree, or more than two meet.
struct WindingClash {
  std::size_t first = 0, second = 0;  ///< `second` is the first triangle of the list that clashes with an earlier one
};
/// The first clash in the order of the triangles; none for a consistently wound mesh. Indices must be valid.
std::optional<WindingClash> find_winding_clash(const TriangleMesh& mesh);

/// Whether the triangles enclose space piece by piece, each piece turned outwards: every edge is run through as often
/// one way as the other and every connected piece has a positive volume. Vertices at one place count as one. Pieces may
/// touch or overlap (a body of several boxes). Such a body's back is never seen. Indices must be valid.
bool is_solid(const TriangleMesh& mesh);

}  // namespace navvy::geometry
