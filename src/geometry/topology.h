// SPDX-License-Identifier: Apache-2.0
// How the triangles of a mesh hang together: free edges, folds that disagree, bodies that enclose
// space.
#pragma once

#include <optional>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// What `inspect` counts. Edges join two vertex indices; weld a mesh first if its faces do not
/// share vertices.
struct MeshReport {
  int free_edges = 0;     ///< used by one triangle: the rim of an open surface
  int crowded_edges = 0;  ///< used by more than two triangles: no surface divides space there
  /// Run through in one direction by two triangles: their fronts lie on different sides.
  int clashing_edges = 0;
  int flat_triangles = 0;  ///< of no area, or with a corner named twice
  int pieces = 0;          ///< parts that share no vertex; vertices without a triangle do not count

  /// Every edge has a triangle on either side.
  bool closed() const { return free_edges == 0 && crowded_edges == 0; }
  /// One front all over every piece.
  bool oriented() const { return clashing_edges == 0; }
};

/// Counts faults of a mesh; a mesh without triangles has none. Time and memory follow n log n of
/// the triangles.
/// @throws InputError as `require_valid` does.
MeshReport inspect(const TriangleMesh& mesh);

/// Two triangles that run along a shared edge in the same direction: their fronts disagree, or more
/// than two meet.
struct WindingClash {
  /// `second` is the first triangle of the list that clashes with an earlier one.
  std::size_t first = 0, second = 0;
};
/// The first clash in the order of the triangles; none for a consistently wound mesh. Indices must
/// be valid.
std::optional<WindingClash> find_winding_clash(const TriangleMesh& mesh);

/// Whether the triangles enclose space piece by piece, each piece turned outwards: every edge is
/// run through as often one way as the other and every connected piece has a positive volume.
/// Vertices at one place count as one. Pieces may touch or overlap (a body of several boxes). Such
/// a body's back is never seen. Indices must be valid.
bool is_solid(const TriangleMesh& mesh);

}  // namespace navvy::geometry
