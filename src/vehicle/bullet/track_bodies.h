// SPDX-License-Identifier: Apache-2.0
// Contacts of crawler tracks with bodies.
#pragma once

#include <vector>

#include "terramechanics/track_body.h"
#include "vehicle/bullet/contact_candidates.h"

namespace navvy::vehicle {

/// Finds where the tracks of crawlers penetrate the collision shapes of other machines, fixed or
/// moving, and pushes both apart by the track's law.
///
/// A track is a row of discs on each of its two lines. Costs a search for each disc and body whose
/// boxes overlap, and one box test per track with nothing near.
class TrackBodies {
 public:
  /// Adds the forces [N] of this step on the track of `wheel` (which has one) and on the bodies
  /// that it touches.
  void push(BulletMachine& own, std::size_t machine, std::size_t wheel,
            const ContactCandidates& bodies, btCollisionWorld& world, double dt);

 private:
  /// Discs of a track, by station and line.
  struct Track {
    std::vector<terramechanics::TrackStation> stations;
    std::vector<Disc> discs;
    double width = 0;  // [m]
  };
  /// Returns the discs of a track and builds them on first use.
  Track& running_track(std::size_t machine, std::size_t wheel, const scene::Wheel& about,
                       const Vec3& p_sprocket);
  /// Collects the bodies whose boxes overlap the track's box in near_.
  void look_round(const BulletMachine& own, const Track& running_track, const Pose& X_WC,
                  const ContactCandidates& bodies);
  /// Finds the contacts of a track with the bodies in near_.
  void touch(Track& running_track, const Pose& X_WC, const scene::Wheel& about,
             btCollisionWorld& world);

  std::vector<const MetBody*> near_;  // bodies near the present track
  // Contacts of the present track; bodies by their index in near_
  std::vector<terramechanics::TrackTouch> touches_;
  std::vector<std::vector<Track>> tracks_;
};

}  // namespace navvy::vehicle
