// SPDX-License-Identifier: Apache-2.0
// Collision shapes that tyres and tracks may touch, and their contacts.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include <memory>
#include <optional>
#include <vector>

#include "terramechanics/tyre_body.h"
#include "vehicle/bullet/bullet_machine.h"
#include "vehicle/bullet/mover.h"

namespace navvy::vehicle {

/// Collision object of one link that a tyre or track may touch, at its current pose.
struct MetBody {
  /// Collision object of the link in Bullet.
  btMultiBodyLinkCollider* collider = nullptr;
  /// Machine to which the link belongs.
  BulletMachine* machine = nullptr;
  /// Index of the link in that machine.
  int link = 0;
  /// Corners of the collision object's bounding box in the world frame [m].
  btVector3 low, high;

  /// Adds a force `f_W` [N] at the point `p_W` [m] on the body for this step, and wakes the body if
  /// it sleeps.
  void push(const Vec3& f_W, const Vec3& p_W) const;
};

/// Flat disc with a rounded rim (a cylinder swept by a ball) that represents a tyre or a piece of
/// track in contacts with bodies. Its distance from a shape is exact up to a penetration of half
/// its thickness.
struct Disc {
  /// Makes a disc.
  /// @param radius outer radius [m]
  /// @param half half of the thickness [m]
  Disc(double radius, double half);
  /// Moves the disc to the pose `X_W` in the world frame. The y axis of that pose is the disc's
  /// axis.
  void place(const Pose& X_W);

  /// Collision shape of the disc.
  std::unique_ptr<btConvexShape> shape;
  /// Collision object of the disc at its current pose.
  std::unique_ptr<btCollisionObject> object;
  /// Centre of the disc in the world frame [m].
  Vec3 center = Vec3::Zero();
  /// Corners of the disc's bounding box in the world frame [m].
  btVector3 low, high;
};

/// List of the collision objects of all machines and obstacles, in the order of machines and links.
/// It is collected anew in each step.
class ContactCandidates {
 public:
  /// Machines of the Bullet engine, in the order of their indices.
  using Machines = std::vector<std::unique_ptr<BulletMachine>>;

  /// Collects the collision objects of all machines and all obstacles (`movers`) at their current
  /// poses. Call it once per step.
  void gather(const Machines& machines, const std::vector<Mover>& movers);
  /// Returns the collision objects that the last gather() collected.
  const std::vector<MetBody>& all() const { return bodies_; }

  /// Returns the contact of a disc with a body; nothing if they do not overlap. `friction` is the
  /// friction coefficient that the contact gets. Costs one query of Bullet if the bounding boxes
  /// overlap.
  static std::optional<terramechanics::BodyTouch> touch(Disc& disc, const MetBody& body,
                                                        double friction, btCollisionWorld& world);

 private:
  /// Collects the collision objects of one machine.
  void gather(BulletMachine& machine);

  /// Collision objects collected in this step.
  std::vector<MetBody> bodies_;
};

}  // namespace navvy::vehicle
