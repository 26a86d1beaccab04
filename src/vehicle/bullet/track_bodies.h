// SPDX-License-Identifier: Apache-2.0
// Belts against bodies: what a crawler meets beside the ground.
#pragma once

#include <vector>

#include "terramechanics/track_body.h"
#include "vehicle/bullet/contact_candidates.h"

namespace navvy::vehicle {

/// Finds where the belts of crawlers reach into the collision shapes of others, standing or moving,
/// and pushes both apart by the belt's law.
///
/// A belt is a row of discs on each of its two lines. Costs a search for each disc and body whose
/// boxes meet, and one look at its box where nothing is near.
class TrackBodies {
 public:
  /// Adds the forces [N] of this step on the belt of `wheel` (which has a track) and on the bodies
  /// that it meets.
  void push(BulletMachine& own, std::size_t machine, std::size_t wheel,
            const ContactCandidates& bodies, btCollisionWorld& world, double dt);

 private:
  /// By machine and wheel. Discs by station and line.
  struct Track {
    std::vector<terramechanics::TrackStation> stations;
    std::vector<Disc> discs;
    double width = 0;  // [m]
  };
  Track& running_track(std::size_t machine, std::size_t wheel, const scene::Wheel& about,
                       const Vec3& p_sprocket);
  /// Whose boxes meet the belt's, in near_.
  void look_round(const BulletMachine& own, const Track& running_track, const Pose& X_WC,
                  const ContactCandidates& bodies);
  void touch(Track& running_track, const Pose& X_WC, const scene::Wheel& about,
             btCollisionWorld& world);

  std::vector<const MetBody*> near_;                 // of this belt
  std::vector<terramechanics::TrackTouch> touches_;  // likewise; bodies by their place in near_
  std::vector<std::vector<Track>> tracks_;
};

}  // namespace navvy::vehicle
