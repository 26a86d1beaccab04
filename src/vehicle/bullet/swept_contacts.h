// SPDX-License-Identifier: Apache-2.0
// Contacts of bodies that move so far in a step that they could pass through each other.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <unordered_set>
#include <vector>

#include "terramechanics/ground_query.h"
#include "vehicle/bullet/ground_shape.h"

namespace navvy::vehicle {

/// Mark of a swept contact, in btManifoldPoint::m_partId0: the bodies are apart and meet within the
/// step.
inline constexpr int kSweptContact = -7;

/// Predicts contacts along the motion of fast bodies.
///
/// Contacts are detected at the poses of a step's start. A body that moves by more than half of its
/// thinnest side in a step could be beyond another body before any contact is found. For such a
/// body, all its shapes and their corners are cast along the motion of the step, relative to the
/// bodies in the way, and each hit becomes a contact with the remaining gap as its distance: the
/// solver lets the bodies close the gap and no more. Corners of bodies thinner than 10 mm also
/// carry them on the ground at any speed. Of thicker and slower bodies only the velocity is read,
/// and their contacts are unchanged.
class SweptContacts {
 public:
  /// Enlarges the bounding boxes of fast bodies to the space that they sweep in a step of `dt` [s],
  /// so that the broad phase finds the pairs. Call it after the boxes were updated.
  void stretch_boxes(btCollisionWorld& world, double dt);
  /// Adds the contacts of fast bodies with each other, with the other bodies and with the ground,
  /// for the pairs that the broad phase has found.
  void add(btCollisionWorld& world, btCollisionDispatcher& dispatcher, btCollisionObject& ground,
           const GroundShape& shape, const terramechanics::GroundQuery& heights, double dt);
  /// Removes the contacts of this step.
  void drop(btCollisionDispatcher& dispatcher);

 private:
  /// Adds one contact: body 0 touches body 1 with its point `p_0` when that has reached `p_1`, both
  /// at the poses of the step's start. `normal` points from body 1 to body 0.
  void contact(btCollisionDispatcher& dispatcher, const btCollisionObject& body_0,
               const btCollisionObject& body_1, const btVector3& p_0, const btVector3& p_1,
               const btVector3& normal);
  /// Casts the corners of `mover`, and with `whole` its shapes too, against `target`.
  void cast(btCollisionDispatcher& dispatcher, btCollisionObject& mover, btCollisionObject& target,
            bool whole, double dt);
  /// Casts the corners of `mover` against the ground; those that are in it by less than the body's
  /// thickness become contacts, too.
  void cast_down(btCollisionDispatcher& dispatcher, btCollisionObject& mover,
                 btCollisionObject& ground, const GroundShape& shape,
                 const terramechanics::GroundQuery& heights, double dt);

  /// Fast and thin bodies of this step; only looked up, never walked.
  std::unordered_set<const btCollisionObject*> fast_;
  /// Contacts of this step, one manifold each.
  std::vector<btPersistentManifold*> manifolds_;
};

}  // namespace navvy::vehicle
