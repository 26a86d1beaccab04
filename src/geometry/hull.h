// SPDX-License-Identifier: Apache-2.0
// Convex hulls of sets of points.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// A plane, and the half-space behind it: all points p with normal . p <= offset.
struct Plane {
  Vec3 normal = Vec3::UnitZ();  ///< unit normal, pointing out of the half-space
  double offset = 0;            ///< distance of the plane from the origin along the normal [m]
};

/// The smallest convex body that contains all given points, described by its surface and by
/// half-spaces.
struct ConvexHull {
  /// Closed surface whose fronts face outwards. The vertices are those of the given points that are
  /// corners of the hull, in lexicographic order.
  TriangleMesh mesh;
  /// One half-space per face; a face may consist of several triangles. A point is in the hull if it
  /// is in all half-spaces.
  std::vector<Plane> planes;
};

/// Computes the convex hull of `points` [m], which may be in any order and contain duplicates.
///
/// The corners are determined exactly on a lattice with a spacing of 2^-40 of the points' extent,
/// so that rounding cannot fold the surface. Triangles form one face if all their points are closer
/// to one plane than 1e-7 of the bounding box's diagonal; the plane of the face passes through the
/// first three of these points in lexicographic order. The result does not depend on the order of
/// the input. For coplanar points the hull has no triangles, and `planes` has two entries with
/// opposite normals. The cost is proportional to the number of points times the number of triangles
/// of the hull: 0.05 s for a thousand points on a sphere, 0.9 s for four thousand; points in the
/// interior cost little.
/// @throws InputError if a coordinate is not finite or all points are collinear
ConvexHull convex_hull(std::vector<Vec3> points);

}  // namespace navvy::geometry
