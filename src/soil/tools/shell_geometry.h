// SPDX-License-Identifier: Apache-2.0
// A shell prepared for the solver: pseudo-normals, free edges, small boxes for broad-phase search,
// hull.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"
#include "geometry/hull.h"
#include "geometry/pieces.h"
#include "scene/machine.h"

namespace navvy::soil {

/// Geometry of one tool in its link frame T. Built once.
///
/// The signed distance comes from the pseudo-normal of the closest face, edge or corner [Baerentzen
/// 2005]. An edge is free when no second triangle shares it; contact fades towards free edges.
/// Vertices are copied; memory is some hundred bytes per triangle.
class ShellGeometry {
 public:
  /// Prepares a shell for cells of `cell` [m].
  /// @throws InputError when the shell has no triangles, one of no area, or an index out of range.
  ShellGeometry(const scene::Shell& shell, double cell);

  const scene::Shell& shell() const { return shell_; }

  /// Data of one triangle for the kernels, in T. Normals point to the front.
  struct Triangle {
    std::array<Vec3, 3> corner;
    Vec3 normal;
    Vec3 centre;
    /// Distance of the farthest corner from the centre [m].
    double radius;
    /// Pseudo-normals of the edges ab bc ca and of the corners.
    std::array<Vec3, 3> edge_normal, corner_normal;
    std::array<bool, 3> edge_free, corner_free;
  };
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<std::array<Vec3, 2>>& rims() const { return rims_; }

  /// Pieces of the triangles no longer than a few cells: corners in T and their triangle.
  using Piece = geometry::MeshPiece;
  const std::vector<Piece>& pieces() const { return pieces_; }

  /// Returns the signed distance of a point in T from the closest plate, positive in front [m]; the
  /// reference of the kernels' query.
  double distance(const Vec3& p) const;
  /// Returns the same, faster when `closest` names a triangle that is likely the closest; sets it
  /// to the closest.
  double distance(const Vec3& p, int& closest) const { return nearest(p, closest).distance; }
  /// Closest point of the plates, in T.
  struct Nearest {
    /// Signed distance [m].
    double distance = 0;
    Vec3 place = Vec3::Zero();
    /// Pseudo-normal there, towards the front; not of unit length.
    Vec3 normal = Vec3::Zero();
  };
  /// Returns the closest point; `closest` as in `distance`.
  Nearest nearest(const Vec3& p, int& closest) const;
  /// Returns true for a point inside the hull (raised over the mouth to hold a heap) and in front.
  bool holds(const Vec3& p) const;
  /// Returns the same, faster when `closest` names a triangle that is likely the closest.
  bool holds(const Vec3& p, int& closest) const;
  /// Returns the hull's corners, and points inside it.
  const std::vector<Vec3>& hull_points() const { return hull_points_; }

 private:
  /// Computes pseudo-normals and free edges.
  void find_normals();
  /// Builds the hull, raised over the mouth.
  void build_hull();

  scene::Shell shell_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<Vec3, 2>> rims_;
  std::vector<Piece> pieces_;
  std::vector<geometry::Plane> hull_;
  std::vector<Vec3> hull_points_;
};

}  // namespace navvy::soil
