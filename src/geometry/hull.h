// SPDX-License-Identifier: Apache-2.0
// Convex hulls of points.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Half-space of the points p with normal . p <= offset.
struct Plane {
  /// Unit vector, outwards.
  Vec3 normal = Vec3::UnitZ();
  /// Distance from the origin along the normal [m].
  double offset = 0;
};

/// Smallest convex body that contains all points, as a surface and as half-spaces.
struct ConvexHull {
  /// Closed surface with fronts outside. Its vertices are points of the input, in lexicographic
  /// order.
  TriangleMesh mesh;
  /// One half-space per face, however many triangles the face has. A point is inside the hull if it
  /// is inside all.
  std::vector<Plane> planes;
};

/// Computes the convex hull of `points` [m], in any order and with duplicates.
///
/// Corners are determined exactly on a lattice of 2^-40 of the points' extent, so rounding cannot
/// fold the surface. Triangles whose points lie within 1e-7 of the box's diagonal of one plane form
/// one face, whose plane passes through the first three such points in lexicographic order; the
/// result does not depend on the order of the input. Coplanar points give a hull without triangles
/// and their plane from both sides. The cost is the number of points times the number of the hull's
/// triangles: 0.05 s for a thousand points on a sphere, 0.9 s for four thousand; points inside are
/// cheap.
/// @throws InputError if a coordinate is not finite or all points are collinear.
ConvexHull convex_hull(std::vector<Vec3> points);

}  // namespace navvy::geometry
