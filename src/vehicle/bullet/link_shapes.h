// SPDX-License-Identifier: Apache-2.0
// Makes Bullet's collision shapes for links and shells of a machine.
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include <limits>
#include <memory>
#include <vector>

#include "scene/machine.h"

namespace navvy::vehicle {

/// All collision shapes of one link, or all plates of one shell, combined into one compound shape.
struct LinkShape {
  /// Triangle meshes to which some of the `parts` refer.
  std::vector<std::unique_ptr<btStridingMeshInterface>> meshes;
  /// Single shapes to which the compound refers.
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  /// Compound of all parts; null for a link without collision shapes.
  std::unique_ptr<btCompoundShape> compound;
  /// Largest friction coefficient of the parts [-], which applies to the whole compound.
  double friction = 0.8;
  /// Smallest side of any part [m]; infinite if there is none, or for triangles that never move.
  double thinnest = std::numeric_limits<double>::infinity();
};

/// Returns the plates of a shell as one compound in the frame of the shell's link. Each triangle of
/// the shell becomes a plate: the triangle swept by a ball of half the plate's thickness.
///
/// Bullet handles a collision of two moving triangle meshes poorly, but it handles convex pieces
/// well. The direction out of a plate with a flat core and a rounded surface is unique as long as
/// no other body reaches the core.
LinkShape make_steel(const scene::Shell& shell);

/// Returns all collision shapes of a link as one compound.
/// @param X_IL pose of the link's own frame in Bullet's frame of the link
/// @param stands true for a link that never moves: its meshes keep their triangles; other meshes
/// are replaced by their convex hulls
/// @throws InputError for a plane, or for a mesh without enough vertices or triangles; FileError
/// for a mesh file that cannot be read
LinkShape make_link_shape(const scene::Link& link, const Pose& X_IL, bool stands);

}  // namespace navvy::vehicle
