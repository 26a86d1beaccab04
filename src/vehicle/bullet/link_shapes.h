// SPDX-License-Identifier: Apache-2.0
// Collision shapes for Bullet.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include <memory>
#include <vector>

#include "scene/machine.h"

namespace navvy::vehicle {

/// All collision shapes of a link in one compound. `compound` is null for a link without any.
struct LinkShape {
  /// Triangles that parts refer to.
  std::vector<std::unique_ptr<btStridingMeshInterface>> meshes;
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::unique_ptr<btCompoundShape> compound;
  /// Largest friction of the parts.
  double friction = 0.8;
};

/// Returns a shell's plates as one compound in the link's own frame: each triangle swept by a ball
/// of half the thickness.
///
/// Bullet cannot handle a moving triangle mesh against another one well, but it can handle convex
/// pieces. A flat core with a round skin has a unique direction out of the plate as long as nothing
/// reaches its middle.
LinkShape make_steel(const scene::Shell& shell);

/// Returns the collision shapes of a link.
/// @param X_IL the link in Bullet's frame
/// @param stands the link never moves: meshes keep their triangles instead of their hull
/// @throws InputError for a plane or a mesh without vertices, FileError.
LinkShape make_link_shape(const scene::Link& link, const Pose& X_IL, bool stands);

}  // namespace navvy::vehicle
