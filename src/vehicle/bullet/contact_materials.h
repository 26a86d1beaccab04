// SPDX-License-Identifier: Apache-2.0
// Contact properties for pairs of materials. Bullet stores one value per body; this class sets the
// values of each contact between collision detection and solver.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/material.h"
#include "vehicle/bullet/bullet_machine.h"

namespace navvy::vehicle {

/// Sets friction, restitution and compliance of every contact whose two sides both have a material
/// [docs/machines.md, materials]. Costs nothing if the scene has no pairs of materials.
class ContactMaterials {
 public:
  /// Takes the scene's table of material pairs. With an empty table, apply() does nothing.
  explicit ContactMaterials(scene::Materials table);
  // pairs_ points into table_, so this class is not copied.
  ContactMaterials(const ContactMaterials&) = delete;
  ContactMaterials& operator=(const ContactMaterials&) = delete;

  /// Stores, in each of the machine's collision objects, its machine, link and material, so that
  /// apply() can find them. Call it before the first apply().
  void mark(BulletMachine& machine) const;
  /// Sets the properties of all contacts. Call it after collision detection, while velocities are
  /// still those of the last step, since a body at rest is recognised by its velocity.
  /// @param ground collision object of the ground
  /// @param gravity gravity in the world frame [m/s2]; the velocity that a body gained from it
  /// while it overlapped the other body does not count as part of an impact
  void apply(btDispatcher& dispatcher, const btCollisionObject& ground, const Vec3& gravity);

 private:
  /// One of the two sides of a contact.
  struct Side {
    /// Index of the side's material, -1 without one.
    int material = -1;
    /// Machine to which the side belongs; null for the ground.
    const BulletMachine* machine = nullptr;
    /// Index of the link in that machine.
    int link = 0;
  };
  /// Returns the index of the material with this name, -1 if the table does not contain it.
  int index_of(const std::string& material) const;
  /// Returns true if a side is the ground or a fixed body.
  static bool stands(const Side& side);
  /// Returns the side of a contact to which the collision object `object` belongs.
  Side side(const btCollisionObject& object, const btCollisionObject& ground) const;
  /// Returns the table's entry for the materials of two sides; null if a side has no material or
  /// the table has no such pair.
  const scene::MaterialPair* pair(const Side& a, const Side& b) const;
  /// Sets the properties of one contact point. `v` is the velocity of body 0 relative to body 1 at
  /// the point [m/s]; `weight` is the acceleration by gravity of body 0 relative to body 1 [m/s2].
  void set(const scene::MaterialPair& pair, const Vec3& v, const Vec3& weight,
           btManifoldPoint& point) const;
  /// Sets the compliance of all contacts between compliant materials.
  void soften(btDispatcher& dispatcher, const btCollisionObject& ground);

  /// Table of material pairs.
  scene::Materials table_;
  /// Names of all materials in the table. Their positions in this list are the materials' indices.
  std::vector<std::string> names_;
  /// Pointers to the table's entries as a square matrix in row-major order, one row and one column
  /// per material index; null for a pair that the table does not contain.
  std::vector<const scene::MaterialPair*> pairs_;
  /// True if any pair in the table is compliant.
  bool soft_ = false;
  /// Index of the ground's material, -1 without one.
  int ground_ = -1;
  /// Number of overlapping contact points in this step, for each pair of bodies with compliant
  /// materials.
  std::map<std::pair<const btCollisionObject*, const btCollisionObject*>, int> bearing_;
};

}  // namespace navvy::vehicle
