// SPDX-License-Identifier: Apache-2.0
// Contacts of tyres with bodies.
#pragma once

#include <optional>
#include <vector>

#include "vehicle/bullet/contact_candidates.h"
#include "vehicle/bullet/track_bodies.h"

namespace navvy::vehicle {

/// Finds where the tyres of each machine penetrate the collision shapes of the others, fixed or
/// moving, and pushes both apart by the tyre's law; tracks of crawlers likewise, by theirs
/// (TrackBodies).
///
/// A contact strip is a disc with a round tread, as wide as the tyre (or half of a single one). The
/// distance of the disc from a shape is exact up to half the width. Costs one search for each disc
/// and body whose boxes overlap.
class TyreBodies {
 public:
  using Machines = ContactCandidates::Machines;

  /// Adds the forces [N] of this step to the trees of wheels and bodies. Call it after the ground's
  /// forces and before gravity. Bodies of `movers` receive none.
  void push(Machines& machines, const std::vector<Mover>& movers, btCollisionWorld& world,
            double dt);

  /// Visits the bristles on bodies and the forces of the last step. A machine alone has none.
  void visit(Archive& a, Machines& machines, const std::vector<Mover>& movers);

 private:
  /// Contact of one strip and the body it belongs to.
  struct Touch {
    terramechanics::BodyTouch at;
    const MetBody* body = nullptr;
  };

  /// Returns the disc of a wheel's strips and builds it on first use.
  Disc& disc(std::size_t machine, std::size_t wheel, const scene::Wheel& about);
  /// Adds the forces of bodies on one tyre.
  void push_tyre(BulletMachine& own, std::size_t machine, std::size_t wheel,
                 btCollisionWorld& world, double dt);
  /// Finds the contacts of a disc with the bodies of other machines.
  void touch(const BulletMachine& own, Disc& disc, double friction, btCollisionWorld& world);
  /// Adds the forces of the contacts of one contact strip.
  void push_track(BulletMachine& own, std::size_t wheel, std::size_t track, double dt);

  ContactCandidates bodies_;    // bodies of this step
  std::vector<Touch> touches_;  // contacts of the present strip
  /// Discs of a wheel's contact strips, by machine and wheel.
  std::vector<std::vector<std::optional<Disc>>> discs_;
  TrackBodies tracks_;
};

}  // namespace navvy::vehicle
