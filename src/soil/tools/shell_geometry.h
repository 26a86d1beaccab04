// SPDX-License-Identifier: Apache-2.0
// A shell prepared for the solver: pseudo-normals, free edges, small boxes for finding who is near,
// its hull.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"
#include "geometry/hull.h"
#include "geometry/pieces.h"
#include "scene/machine.h"

namespace navvy::soil {

/// Geometry of one tool in its link frame T. Built once.
class ShellGeometry {
 public:
  /// @throws InputError when the shell has no triangles, one of no area, or an index out of range.
  ShellGeometry(const scene::Shell& shell, double cell);

  const scene::Shell& shell() const { return shell_; }

  /// What the kernels need of triangle t, in T. Normals point to the front.
  struct Triangle {
    std::array<Vec3, 3> corner;
    Vec3 normal;
    Vec3 centre;
    double radius;  ///< of the farthest corner from the centre [m]
    /// Pseudo-normals of edges ab bc ca and of corners.
    std::array<Vec3, 3> edge_normal, corner_normal;
    std::array<bool, 3> edge_free, corner_free;
  };
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<std::array<Vec3, 2>>& rims() const { return rims_; }

  /// Pieces of the triangles no longer than a few cells: corners in T and whose triangle they are.
  using Piece = geometry::MeshPiece;
  const std::vector<Piece>& pieces() const { return pieces_; }

  /// Signed distance of a point in T from the closest plate, positive in front [m]; the reference
  /// of the kernels' query.
  double distance(const Vec3& p) const;
  /// The same, faster when `closest` names a triangle that is likely the closest; becomes the one
  /// that is.
  double distance(const Vec3& p, int& closest) const { return nearest(p, closest).distance; }
  /// The place of the plate that is closest to a point, in T.
  struct Nearest {
    double distance = 0;  ///< signed, as `distance` has it [m]
    Vec3 place = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  ///< pseudo-normal there, to the front; no unit
  };
  Nearest nearest(const Vec3& p, int& closest) const;
  /// Inside the hull (raised over the mouth to hold a heap) and in front.
  bool holds(const Vec3& p) const;
  bool holds(const Vec3& p, int& closest) const;
  /// The hull's corners, and points inside it.
  const std::vector<Vec3>& hull_points() const { return hull_points_; }

 private:
  void find_normals();
  void build_hull();

  scene::Shell shell_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<Vec3, 2>> rims_;
  std::vector<Piece> pieces_;
  std::vector<geometry::Plane> hull_;
  std::vector<Vec3> hull_points_;
};

}  // namespace navvy::soil
