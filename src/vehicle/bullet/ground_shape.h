// SPDX-License-Identifier: Apache-2.0
// The ground as a collision shape for Bullet.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include <vector>

#include "terramechanics/ground_query.h"

namespace navvy::vehicle {

/// Collision shape of the whole ground: triangles between the nodes of the ground's grid, which are
/// generated on demand.
///
/// The shape stores no heights between queries, so each body collides with the ground of the
/// current step at full resolution, wherever it is. Costs two triangles per grid cell under a
/// body's bounding box.
class GroundShape final : public btConcaveShape {
 public:
  /// Makes a shape without ground. Bullet would treat its custom shape type as a signed distance
  /// field; for this type it asks for triangles.
  GroundShape() { m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE; }

  /// Sets the ground for the following queries; null for no ground. The ground must exist as long
  /// as queries are made.
  void set_ground(const terramechanics::GroundQuery* ground) { ground_ = ground; }

  /// Returns a bounding box that contains everything.
  void getAabb(const btTransform& t, btVector3& low, btVector3& high) const override;
  /// Calls `callback` for each triangle of the ground whose cell is under the box from `low` to
  /// `high` in the world frame [m] and not entirely below it. Under boxes of more than 256 cells
  /// along a side, grid nodes are skipped.
  void processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                           const btVector3& high) const override;

  /// Returns the unit direction in the world frame in which the ground pushes a body at the contact
  /// point `p_W` [m]. Among the possible directions it is the closest one to the detected contact
  /// normal `normal_W` (unit vector, away from the ground).
  ///
  /// Bullet treats each triangle separately, so a body that slides over a plane of many triangles
  /// would catch on their edges. Here, a contact on a plane has only the plane's normal. A contact
  /// at a ridge may have any direction between the normals of the two faces.
  Vec3 outward(const Vec3& p_W, const Vec3& normal_W) const;

  /// Does nothing: the ground is never scaled. Required by Bullet.
  void setLocalScaling(const btVector3&) override {}
  /// Returns the scaling, which is always 1. Required by Bullet.
  const btVector3& getLocalScaling() const override { return unit_; }
  /// Returns zero inertia, since the ground never moves. Required by Bullet.
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  /// Returns the name of the shape. Required by Bullet.
  const char* getName() const override { return "Ground"; }

 private:
  /// Returns the upward normal of a triangle of the grid cell ix, iy, scaled to z = 1. Each cell
  /// has two triangles; `lower` selects the one that contains the cell's corner at the smallest x
  /// and y.
  Vec3 steepness(int ix, int iy, bool lower) const;

  /// Ground for the queries; null for no ground.
  const terramechanics::GroundQuery* ground_ = nullptr;
  /// Scaling of the shape, which never changes.
  btVector3 unit_{1, 1, 1};
  /// Heights of the grid nodes in the current query [m].
  mutable std::vector<double> height_;
};

}  // namespace navvy::vehicle
