// SPDX-License-Identifier: Apache-2.0
// The collision shapes that tyres and belts meet, and where.
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

/// A body's shape where it is now.
struct MetBody {
  btMultiBodyLinkCollider* collider = nullptr;
  BulletMachine* machine = nullptr;
  int link = 0;
  btVector3 low, high;

  /// Pushes it, and wakes what sleeps.
  void push(const Vec3& f_W, const Vec3& p_W) const;
};

/// A flat disc swept by a ball: what turns or runs round, as bodies meet it. Its distance from a
/// shape is exact up to half its thickness.
struct Disc {
  /// @param half of its thickness [m]
  Disc(double radius, double half);
  /// To `X_W`, y along its axle.
  void place(const Pose& X_W);

  std::unique_ptr<btConvexShape> shape;
  std::unique_ptr<btCollisionObject> object;
  Vec3 center = Vec3::Zero();
  btVector3 low, high;  // its box
};

/// All shapes of machines and movers, in the order of their numbers, found anew in each step.
class ContactCandidates {
 public:
  using Machines = std::vector<std::unique_ptr<BulletMachine>>;

  void gather(const Machines& machines, const std::vector<Mover>& movers);
  const std::vector<MetBody>& all() const { return bodies_; }

  /// Where a disc that slides with `friction` reaches into a body, if it does. Costs one search
  /// where their boxes meet.
  static std::optional<terramechanics::BodyTouch> touch(Disc& disc, const MetBody& body,
                                                        double friction, btCollisionWorld& world);

 private:
  void gather(BulletMachine& machine);

  std::vector<MetBody> bodies_;
};

}  // namespace navvy::vehicle
