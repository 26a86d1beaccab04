// SPDX-License-Identifier: Apache-2.0
// Collision shapes and the ground's patch as Bullet wants them.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>

#include <memory>
#include <vector>

#include "scene/machine.h"

namespace navvy::vehicle {

/// All collision shapes of a link in one compound. Empty `compound` when the link has none.
struct LinkShape {
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::unique_ptr<btCompoundShape> compound;
  double friction = 0.8;  ///< largest of the parts
};

/// @param X_IL the link in Bullet's frame. @throws InputError for a plane or a mesh without vertices, FileError.
LinkShape make_link_shape(const scene::Link& link, const Pose& X_IL);

/// Heights under rigid bodies. The heights are kept relative to their middle, so the shape's box is no larger than the
/// ground it holds.
struct GroundPatch {
  std::vector<double> height;
  std::unique_ptr<btHeightfieldTerrainShape> shape;
  Vec3 center = Vec3::Zero();  ///< where the shape's origin lies in W

  GroundPatch() = default;
  GroundPatch(int nx, int ny, double spacing, const Vec2& corner, const std::vector<float>& heights);
};

}  // namespace navvy::vehicle
