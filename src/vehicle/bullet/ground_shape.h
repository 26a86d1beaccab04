// SPDX-License-Identifier: Apache-2.0
// The ground as a collision shape of Bullet.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include <vector>

#include "terramechanics/ground_query.h"

namespace navvy::vehicle {

/// The whole ground as triangles between the nodes of its grid, generated on demand.
///
/// It stores no heights: each body meets the ground of the current step at full resolution,
/// wherever it is. Costs two triangles per cell under a body's box and nothing elsewhere.
class GroundShape final : public btConcaveShape {
 public:
  // Bullet takes its custom type for a signed distance field; from this type it asks for triangles.
  GroundShape() { m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE; }

  /// Sets the ground for the following queries; null: no ground. It must outlive them.
  void set_ground(const terramechanics::GroundQuery* ground) { ground_ = ground; }

  /// Returns an infinite box.
  void getAabb(const btTransform& t, btVector3& low, btVector3& high) const override;
  void processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                           const btVector3& high) const override;

  /// Returns the direction in which the ground pushes at `p_W` [m], closest to the contact normal
  /// `normal_W` (unit, away from the ground). Bullet treats each triangle alone, so a body that
  /// slides over a plane of many would catch on their edges. Here only a ridge has a range of
  /// directions: all between those of its two faces.
  Vec3 outward(const Vec3& p_W, const Vec3& normal_W) const;

  // Required by Bullet; the ground is never scaled and never moves.
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return unit_; }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "Ground"; }

 private:
  /// Returns the upward normal of a triangle of the grid, scaled to z = 1. The lower triangle of a
  /// cell contains its first corner.
  Vec3 steepness(int ix, int iy, bool lower) const;

  const terramechanics::GroundQuery* ground_ = nullptr;
  btVector3 unit_{1, 1, 1};
  mutable std::vector<double> height_;  // of the nodes of one query
};

}  // namespace navvy::vehicle
