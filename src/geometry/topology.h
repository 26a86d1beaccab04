// SPDX-License-Identifier: Apache-2.0
// Topology of meshes: consistent winding, and closed bodies.
#pragma once

#include <optional>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Two triangles that run along a shared edge in the same direction. Either their fronts are on
/// opposite sides of the surface, or more than two triangles meet at the edge.
struct WindingClash {
  /// Indices of the two triangles; `first` is the one that comes earlier in the list of the mesh.
  std::size_t first = 0, second = 0;
};
/// Returns the first two triangles that run along a shared edge in the same direction: those whose
/// `second` index is lowest. Returns nothing if the mesh is wound consistently. Indices in the mesh
/// must be valid.
std::optional<WindingClash> find_winding_clash(const TriangleMesh& mesh);

/// Returns true if each connected part of the mesh encloses a volume and faces outwards: every edge
/// is used equally often in both directions, and every part has a positive volume. Vertices at the
/// same position count as one. Parts may touch or overlap, as in a body composed of several boxes.
/// The backs of the triangles of such a body are never visible. Indices in the mesh must be valid.
bool is_solid(const TriangleMesh& mesh);

}  // namespace navvy::geometry
