// SPDX-License-Identifier: Apache-2.0
// Tyres against bodies: what a wheel meets beside the ground.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include <memory>
#include <vector>

#include "terramechanics/tyre_body.h"
#include "vehicle/bullet/machine.h"
#include "vehicle/bullet/mover.h"

namespace navvy::vehicle {

/// Finds where the tyres of each machine reach into the collision shapes of the others, standing or moving, and pushes
/// both apart by the tyre's law.
///
/// A track is a disc with a round tread, as wide as the tyre (or half of a single one): the distance of the disc from
/// a shape is exact up to half the width. Costs one search for each disc and body whose boxes meet.
class TyreBodies {
 public:
  using Machines = std::vector<std::unique_ptr<BulletMachine>>;

  /// Adds the forces [N] of this step to the trees of wheels and bodies: after the ground's, before gravity. Bodies of
  /// `movers` take none.
  void push(Machines& machines, const std::vector<Mover>& movers, btCollisionWorld& world, double dt);

  /// Stretch of the tread on bodies, and the forces of the last step. A machine alone meets nobody and has none.
  void visit(Archive& a, Machines& machines, const std::vector<Mover>& movers);

 private:
  /// A body's shape where it is now.
  struct Body {
    btMultiBodyLinkCollider* collider = nullptr;
    BulletMachine* machine = nullptr;
    int link = 0;
    btVector3 low, high;
  };
  struct Touch {
    terramechanics::BodyTouch at;
    const Body* body = nullptr;
  };
  /// The disc of a wheel's tracks: by machine and wheel.
  struct Disc {
    std::unique_ptr<btConvexShape> shape;
    std::unique_ptr<btCollisionObject> object;
  };

  void gather(const Machines& machines, const std::vector<Mover>& movers);
  void gather(BulletMachine& machine);
  Disc& disc(std::size_t machine, std::size_t wheel, const scene::Wheel& about);
  void touch(const BulletMachine& own, Disc& disc, const Pose& X_WTrack, const scene::Wheel& about,
             btCollisionWorld& world);
  void push_track(BulletMachine& own, std::size_t wheel, std::size_t track, double dt);

  std::vector<Body> bodies_;    // of this step
  std::vector<Touch> touches_;  // of this track
  std::vector<std::vector<Disc>> discs_;
};

}  // namespace navvy::vehicle
