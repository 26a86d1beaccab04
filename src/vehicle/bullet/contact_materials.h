// SPDX-License-Identifier: Apache-2.0
// Pairs of materials between detection and solve: Bullet knows one number a body, how two touch is
// said contact by contact.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/material.h"
#include "vehicle/bullet/bullet_machine.h"

namespace navvy::vehicle {

/// Sets friction, rebound and softness of every contact whose two sides have a material
/// [docs/machines.md, materials]. Costs nothing without a table.
class ContactMaterials {
 public:
  explicit ContactMaterials(scene::Materials table);
  ContactMaterials(const ContactMaterials&) = delete;  // pairs_ points into table_
  ContactMaterials& operator=(const ContactMaterials&) = delete;

  /// Tells the colliders of a machine whose they are, before the first `apply`.
  void mark(BulletMachine& machine) const;
  /// After detection, while velocities are still those of the step before: what rests has none.
  /// @param gravity [m/s2], W: what a body gained of it within the other is no part of its blow.
  void apply(btDispatcher& dispatcher, const btCollisionObject& ground, const Vec3& gravity);

 private:
  /// One side of a contact.
  struct Side {
    int material = -1;
    const BulletMachine* machine = nullptr;  ///< null: the ground
    int link = 0;
  };
  int index_of(const std::string& material) const;
  static bool stands(const Side& side);
  Side side(const btCollisionObject& object, const btCollisionObject& ground) const;
  /// The pair of a manifold; null where one of both has no material.
  const scene::MaterialPair* pair(const Side& a, const Side& b) const;
  /// `v`: of body 0 against body 1 there [m/s]; `weight`: acceleration of body 0 against body 1
  /// [m/s2].
  void set(const scene::MaterialPair& pair, const Vec3& v, const Vec3& weight,
           btManifoldPoint& point) const;
  void soften(btDispatcher& dispatcher, const btCollisionObject& ground);

  scene::Materials table_;
  std::vector<std::string> names_;
  std::vector<const scene::MaterialPair*> pairs_;  ///< by material and material
  bool soft_ = false;                              ///< some pair is
  int ground_ = -1;
  /// Points that bear in this step, by the two bodies.
  std::map<std::pair<const btCollisionObject*, const btCollisionObject*>, int> bearing_;
};

}  // namespace navvy::vehicle
