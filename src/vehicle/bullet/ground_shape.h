// SPDX-License-Identifier: Apache-2.0
// The ground under rigid bodies as a shape of Bullet.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include <vector>

#include "terramechanics/ground_query.h"

namespace navvy::vehicle {

/// The whole ground as triangles between the nodes of its lattice, asked for as they are needed.
///
/// It keeps no heights: each body meets the ground of this very step at full resolution, wherever
/// it is and however far from the others. It costs two triangles a cell under a body's box and
/// nothing elsewhere.
class GroundShape final : public btConcaveShape {
 public:
  // Bullet takes its custom type for a signed distance field; of this one it asks for triangles, as
  // it should.
  GroundShape() { m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE; }

  /// Who answers from now on; null: there is no ground. Must outlive the next query.
  void set_ground(const terramechanics::GroundQuery* ground) { ground_ = ground; }

  /// Everywhere: it has no sides.
  void getAabb(const btTransform& t, btVector3& low, btVector3& high) const override;
  void processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                           const btVector3& high) const override;

  /// The way in which the ground pushes at `p_W` [m], next to the `normal_W` that a contact found
  /// there (unit, away from the ground). Bullet meets each triangle alone, so a body that slides
  /// over a plane of many hooks onto their sides; here only a ridge has more than one way: all
  /// between those of its two faces.
  Vec3 outward(const Vec3& p_W, const Vec3& normal_W) const;

  // What Bullet wants of every shape: it is never scaled and never moves.
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return unit_; }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "Ground"; }

 private:
  /// Of a triangle of the lattice in full, upward, its z 1: the lower one of a cell is that of its
  /// first corner.
  Vec3 steepness(int ix, int iy, bool lower) const;

  const terramechanics::GroundQuery* ground_ = nullptr;
  btVector3 unit_{1, 1, 1};
  mutable std::vector<double> height_;  // of the nodes of one query
};

}  // namespace navvy::vehicle
