// SPDX-License-Identifier: Apache-2.0
// Geometry of a shell as the solver needs it: pseudo-normals, free edges, small pieces for
// broad-phase search, and convex hull.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/math.h"
#include "geometry/hull.h"
#include "geometry/pieces.h"
#include "scene/machine.h"

namespace navvy::soil {

/// Geometry of one tool in its link frame T, computed once.
///
/// The sign of a distance to the shell comes from the pseudo-normal of the closest face, edge or
/// corner [Baerentzen 2005]. An edge is free if only one triangle has it; contact fades towards
/// free edges. The shell is copied; memory is some hundred bytes per triangle.
class ShellGeometry {
 public:
  /// Prepares a shell for a grid with cells of edge `cell` [m].
  /// @throws InputError when the shell has no triangles, a triangle without area, or a vertex index
  /// out of range.
  ShellGeometry(const scene::Shell& shell, double cell);

  /// Returns the shell that this geometry was made from.
  const scene::Shell& shell() const { return shell_; }

  /// One triangle of the shell, in T. Normals point to the front side of the shell.
  struct Triangle {
    /// Corners a, b, c [m].
    std::array<Vec3, 3> corner;
    /// Unit normal of the face.
    Vec3 normal;
    /// Mean of the corners [m].
    Vec3 centre;
    /// Distance from the centre to the farthest corner [m].
    double radius;
    /// Pseudo-normals, not of unit length: edge_normal of the edges ab, bc, ca; corner_normal of
    /// the corners a, b, c.
    std::array<Vec3, 3> edge_normal, corner_normal;
    /// True where the shell ends: edge_free for the edges ab, bc, ca; corner_free for corners on a
    /// free edge.
    std::array<bool, 3> edge_free, corner_free;
  };
  /// Returns the triangles, in the order of the shell.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Returns the end points in T [m] of the free edges. For a closed body, which has none, the
  /// sharp convex edges take their place.
  const std::vector<std::array<Vec3, 2>>& rims() const { return rims_; }

  /// Part of a triangle no longer than a few cells: its corners in T, and the index of the
  /// triangle.
  using Piece = geometry::MeshPiece;
  /// Returns the pieces of all triangles. Their bounding boxes are tighter than those of the
  /// triangles.
  const std::vector<Piece>& pieces() const { return pieces_; }

  /// Returns the signed distance from the closest plate to a point in T, positive in front of the
  /// plate [m]. It is the reference for the kernels' query.
  double distance(const Vec3& p) const;
  /// Returns the signed distance like `distance(p)`. `closest`: on input the index of a triangle
  /// that is probably the closest, which makes the search faster; on output the index of the
  /// closest triangle.
  double distance(const Vec3& p, int& closest) const { return nearest(p, closest).distance; }
  /// Closest point of the shell to a given point.
  struct Nearest {
    /// Signed distance from the shell to the given point, positive in front [m].
    double distance = 0;
    /// Closest point of the shell, in T [m].
    Vec3 place = Vec3::Zero();
    /// Pseudo-normal at the closest point, towards the front; not of unit length.
    Vec3 normal = Vec3::Zero();
  };
  /// Returns the point of the shell closest to `p` in T. `closest` as in `distance`.
  Nearest nearest(const Vec3& p, int& closest) const;
  /// Returns the same for a point whose closest triangles are all in `among`, in ascending order.
  Nearest nearest(const Vec3& p, std::span<const int> among) const;
  /// Returns the distance of triangle `triangle` from `p` in T [m].
  double distance_to(int triangle, const Vec3& p) const;
  /// Returns true if the shell holds soil at `p` in T: if the point is in front of the closest
  /// plate and inside the convex hull, which is raised over the mouth by the height of a heap.
  bool holds(const Vec3& p) const;
  /// Returns the same as `holds(p)`. `closest` as in `distance`.
  bool holds(const Vec3& p, int& closest) const;
  /// Returns the points in T [m] whose convex hull is the hull of `holds`: all corners, and the
  /// rims raised by the height of a heap.
  const std::vector<Vec3>& hull_points() const { return hull_points_; }
  /// Returns the planes of that hull; normals point outwards.
  const std::vector<geometry::Plane>& hull() const { return hull_; }

 private:
  /// Computes triangles, pseudo-normals and free edges.
  void find_normals();
  /// Computes the convex hull, raised over the mouth.
  void build_hull();

  /// Copy of the shell.
  scene::Shell shell_;
  /// Triangles of the shell.
  std::vector<Triangle> triangles_;
  /// End points of the free edges, see rims().
  std::vector<std::array<Vec3, 2>> rims_;
  /// Pieces of the triangles.
  std::vector<Piece> pieces_;
  /// Planes of the convex hull; normals point outwards.
  std::vector<geometry::Plane> hull_;
  /// Points that span the hull.
  std::vector<Vec3> hull_points_;
};

}  // namespace navvy::soil
