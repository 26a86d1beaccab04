// SPDX-License-Identifier: Apache-2.0
// Topology of meshes: consistent winding and closed bodies.
#pragma once

#include <optional>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Two triangles that traverse a shared edge in the same direction: their fronts disagree, or more
/// than two triangles meet.
struct WindingClash {
  /// Indices of the triangles; `second` is the first triangle in the list that clashes with an
  /// earlier one.
  std::size_t first = 0, second = 0;
};
/// Returns the first clash in the order of the triangles, or nothing for a consistently wound mesh.
/// Indices must be valid.
std::optional<WindingClash> find_winding_clash(const TriangleMesh& mesh);

/// Returns true if each connected piece of the mesh encloses space and faces outwards: every edge
/// is traversed equally often in both directions, and every piece has a positive volume. Vertices
/// at one place count as one. Pieces may touch or overlap, as in a body of several boxes. The back
/// of such a body is never visible. Indices must be valid.
bool is_solid(const TriangleMesh& mesh);

}  // namespace navvy::geometry
