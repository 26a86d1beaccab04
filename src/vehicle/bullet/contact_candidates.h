// SPDX-License-Identifier: Apache-2.0
// Collision shapes near tyres and tracks, and their contacts.
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

/// Shape of a body at its present pose.
struct MetBody {
  btMultiBodyLinkCollider* collider = nullptr;
  BulletMachine* machine = nullptr;
  int link = 0;
  btVector3 low, high;

  /// Applies a force at p_W [N, m], and wakes a sleeping body.
  void push(const Vec3& f_W, const Vec3& p_W) const;
};

/// Flat disc swept by a ball: a tyre or a piece of track, as bodies meet it. Its distance from a
/// shape is exact up to half its thickness.
struct Disc {
  /// Makes the shape.
  /// @param half of its thickness [m]
  Disc(double radius, double half);
  /// Moves the disc to `X_W`, y along its axle.
  void place(const Pose& X_W);

  std::unique_ptr<btConvexShape> shape;
  std::unique_ptr<btCollisionObject> object;
  Vec3 center = Vec3::Zero();
  btVector3 low, high;  // bounding box
};

/// Collects the shapes of all machines and obstacles in the order of their numbers, anew in each
/// step.
class ContactCandidates {
 public:
  using Machines = std::vector<std::unique_ptr<BulletMachine>>;

  /// Collects all shapes at their present poses. Call it once per step.
  void gather(const Machines& machines, const std::vector<Mover>& movers);
  /// Returns the shapes collected last.
  const std::vector<MetBody>& all() const { return bodies_; }

  /// Returns the contact of a disc that slides with `friction` on a body, if they overlap. Costs
  /// one search where their boxes overlap.
  static std::optional<terramechanics::BodyTouch> touch(Disc& disc, const MetBody& body,
                                                        double friction, btCollisionWorld& world);

 private:
  /// Collects the shapes of one machine.
  void gather(BulletMachine& machine);

  std::vector<MetBody> bodies_;
};

}  // namespace navvy::vehicle
