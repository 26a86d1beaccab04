// SPDX-License-Identifier: Apache-2.0
// Contacts of tyres and tracks with rigid bodies.
#pragma once

#include <optional>
#include <vector>

#include "vehicle/bullet/contact_candidates.h"
#include "vehicle/bullet/track_bodies.h"

namespace navvy::vehicle {

/// Finds where the tyres of each machine penetrate the collision shapes of other machines, fixed or
/// moving, and pushes both apart by the force law of terramechanics/tyre_body.h. For crawler
/// tracks, it calls TrackBodies.
///
/// Each contact strip of a tyre is a disc with a round tread, as wide as the tyre (or as half of a
/// single tyre). The distance of the disc from a shape is exact up to a penetration of half the
/// width. Costs one query for each disc and body whose bounding boxes overlap.
class TyreBodies {
 public:
  /// Machines of the Bullet engine, in the order of their indices.
  using Machines = ContactCandidates::Machines;

  /// Adds the contact forces of this step of `dt` [s] to the machines with the wheels and to the
  /// bodies that they touch. Call it after the forces of the ground and before gravity. Bodies of
  /// obstacles (`movers`) push the wheels but are not moved.
  void push(Machines& machines, const std::vector<Mover>& movers, btCollisionWorld& world,
            double dt);

  /// Saves, loads or hashes, for every wheel, the bristles or shear on bodies and the forces of the
  /// last step. A machine that is alone in its engine has no such state.
  void visit(Archive& a, Machines& machines, const std::vector<Mover>& movers);

 private:
  /// Contact of one contact strip with a body.
  struct Touch {
    /// Point, normal, depth and velocity of the contact.
    terramechanics::BodyTouch at;
    /// Body that the strip touches.
    const MetBody* body = nullptr;
  };

  /// Returns the disc of a wheel's contact strips. It is made at the first call.
  Disc& disc(std::size_t machine, std::size_t wheel, const scene::Wheel& about);
  /// Adds the forces between bodies and both contact strips of one tyre.
  void push_tyre(BulletMachine& own, std::size_t machine, std::size_t wheel,
                 btCollisionWorld& world, double dt);
  /// Finds the contacts of a disc with the bodies of other machines and stores them in `touches_`.
  /// `friction` is the tyre's friction coefficient.
  void touch(const BulletMachine& own, Disc& disc, double friction, btCollisionWorld& world);
  /// Adds the forces of the contacts in `touches_` to one contact strip and the bodies. `track` is
  /// the index of the strip, 0 for left and 1 for right.
  void push_track(BulletMachine& own, std::size_t wheel, std::size_t track, double dt);

  /// Bodies of all machines and obstacles in this step.
  ContactCandidates bodies_;
  /// Contacts of the contact strip that is being computed.
  std::vector<Touch> touches_;
  /// Disc of each wheel's contact strips, indexed by machine and wheel; empty until the first use.
  std::vector<std::vector<std::optional<Disc>>> discs_;
  /// Contacts of crawler tracks with bodies.
  TrackBodies tracks_;
};

}  // namespace navvy::vehicle
