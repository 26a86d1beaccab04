// SPDX-License-Identifier: Apache-2.0
// Contact properties by pairs of materials. Bullet stores one value per body; this sets them
// contact by contact between detection and solve.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/material.h"
#include "vehicle/bullet/bullet_machine.h"

namespace navvy::vehicle {

/// Sets friction, restitution and compliance of every contact whose two sides have a material
/// [docs/machines.md, materials]. Costs nothing without a table.
class ContactMaterials {
 public:
  /// Takes the table of material pairs; an empty one disables this class.
  explicit ContactMaterials(scene::Materials table);
  ContactMaterials(const ContactMaterials&) = delete;  // pairs_ points into table_
  ContactMaterials& operator=(const ContactMaterials&) = delete;

  /// Links the colliders of a machine to it. Call it before the first `apply`.
  void mark(BulletMachine& machine) const;
  /// Sets the properties of all contacts. Call it after detection, while velocities are still those
  /// of the last step: a resting body has none.
  /// @param gravity [m/s2], W: the velocity that a body gained from it inside the other is no part
  /// of the impact.
  void apply(btDispatcher& dispatcher, const btCollisionObject& ground, const Vec3& gravity);

 private:
  /// One side of a contact.
  struct Side {
    int material = -1;
    /// Null for the ground.
    const BulletMachine* machine = nullptr;
    int link = 0;
  };
  /// Returns the index of a material, -1 if the table has none of this name.
  int index_of(const std::string& material) const;
  /// Returns whether a side is the ground or a fixed body.
  static bool stands(const Side& side);
  /// Returns the side of a contact that an object belongs to.
  Side side(const btCollisionObject& object, const btCollisionObject& ground) const;
  /// Returns the pair of a manifold; null if one side has no material.
  const scene::MaterialPair* pair(const Side& a, const Side& b) const;
  /// Sets the properties of one contact. `v` is the velocity of body 0 against body 1 there [m/s],
  /// `weight` the acceleration of body 0 against body 1 [m/s2].
  void set(const scene::MaterialPair& pair, const Vec3& v, const Vec3& weight,
           btManifoldPoint& point) const;
  void soften(btDispatcher& dispatcher, const btCollisionObject& ground);

  scene::Materials table_;
  std::vector<std::string> names_;
  std::vector<const scene::MaterialPair*> pairs_;  ///< by material and material
  bool soft_ = false;                              ///< true if any pair is compliant
  int ground_ = -1;
  /// Number of contact points that carry load in this step, by the two bodies.
  std::map<std::pair<const btCollisionObject*, const btCollisionObject*>, int> bearing_;
};

}  // namespace navvy::vehicle
