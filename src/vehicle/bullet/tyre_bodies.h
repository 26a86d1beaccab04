// SPDX-License-Identifier: Apache-2.0
// Tyres against bodies: what a wheel meets beside the ground.
#pragma once

#include <optional>
#include <vector>

#include "vehicle/bullet/contact_candidates.h"
#include "vehicle/bullet/track_bodies.h"

namespace navvy::vehicle {

/// Finds where the tyres of each machine reach into the collision shapes of the others, standing or
/// moving, and pushes both apart by the tyre's law; belts of crawlers likewise, by theirs
/// (TrackBodies).
///
/// A track is a disc with a round tread, as wide as the tyre (or half of a single one): the
/// distance of the disc from a shape is exact up to half the width. Costs one search for each disc
/// and body whose boxes meet.
class TyreBodies {
 public:
  using Machines = ContactCandidates::Machines;

  /// Adds the forces [N] of this step to the trees of wheels and bodies: after the ground's, before
  /// gravity. Bodies of `movers` take none.
  void push(Machines& machines, const std::vector<Mover>& movers, btCollisionWorld& world,
            double dt);

  /// Stretch of the tread on bodies, and the forces of the last step. A machine alone meets nobody
  /// and has none.
  void visit(Archive& a, Machines& machines, const std::vector<Mover>& movers);

 private:
  struct Touch {
    terramechanics::BodyTouch at;
    const MetBody* body = nullptr;
  };

  Disc& disc(std::size_t machine, std::size_t wheel, const scene::Wheel& about);
  void push_tyre(BulletMachine& own, std::size_t machine, std::size_t wheel,
                 btCollisionWorld& world, double dt);
  void touch(const BulletMachine& own, Disc& disc, double friction, btCollisionWorld& world);
  void push_track(BulletMachine& own, std::size_t wheel, std::size_t track, double dt);

  ContactCandidates bodies_;    // of this step
  std::vector<Touch> touches_;  // of this track
  /// Of a wheel's tracks: by machine and wheel.
  std::vector<std::vector<std::optional<Disc>>> discs_;
  TrackBodies tracks_;
};

}  // namespace navvy::vehicle
