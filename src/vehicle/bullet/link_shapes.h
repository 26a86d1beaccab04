// SPDX-License-Identifier: Apache-2.0
// Collision shapes as Bullet wants them.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include <memory>
#include <vector>

#include "scene/machine.h"

namespace navvy::vehicle {

/// All collision shapes of a link in one compound. Empty `compound` when the link has none.
struct LinkShape {
  /// That parts read their triangles from.
  std::vector<std::unique_ptr<btStridingMeshInterface>> meshes;
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::unique_ptr<btCompoundShape> compound;
  double friction = 0.8;  ///< largest of the parts
};

/// A shell's plates as one compound in the link's own frame: each triangle swept by a ball of half
/// the thickness.
///
/// Bullet has no good answer for a moving mesh of triangles against another; of convex pieces it
/// has, and a flat core with a round skin keeps the way out of a plate known as long as nothing
/// reaches to its middle.
LinkShape make_steel(const scene::Shell& shell);

/// @param X_IL the link in Bullet's frame. @param stands it never moves: meshes are their
/// triangles, not their hull.
/// @throws InputError for a plane or a mesh without vertices, FileError.
LinkShape make_link_shape(const scene::Link& link, const Pose& X_IL, bool stands);

}  // namespace navvy::vehicle
