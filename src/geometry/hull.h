// SPDX-License-Identifier: Apache-2.0
// Convex hulls of points.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// The half-space of points p with normal . p <= offset.
struct Plane {
  Vec3 normal = Vec3::UnitZ();  ///< unit, outwards
  double offset = 0;            ///< [m]
};

/// The smallest convex body that holds all points, as a surface and as half-spaces.
struct ConvexHull {
  /// Closed, fronts outside; its vertices are points of the input, in lexicographic order.
  TriangleMesh mesh;
  /// One a face, however many triangles it has; a point is inside when it is inside all.
  std::vector<Plane> planes;
};

/// The hull of `points` [m], in any order and with doubles.
///
/// Which points are corners is decided exactly on a lattice of 2^-40 of the points' extent, so no
/// noise of rounding folds the surface. Triangles whose points lie within 1e-7 of the box's
/// diagonal of one plane are one face, whose plane goes through the first three such points in
/// lexicographic order: the result does not depend on the order of the input. Points of one plane
/// have a hull without triangles, and that plane from both sides. The cost is the number of points
/// times that of the hull's triangles: 0.05 s for a thousand points of a sphere, 0.9 s for four
/// thousand; points inside are cheap.
/// @throws InputError when a coordinate is not finite or all points lie on one line.
ConvexHull convex_hull(std::vector<Vec3> points);

}  // namespace navvy::geometry
