// SPDX-License-Identifier: Apache-2.0
// Contacts of crawler tracks with rigid bodies.
#pragma once

#include <vector>

#include "terramechanics/track_body.h"
#include "vehicle/bullet/contact_candidates.h"

namespace navvy::vehicle {

/// Finds where crawler tracks penetrate the collision shapes of other machines, fixed or moving,
/// and pushes both apart by the force law of terramechanics/track_body.h.
///
/// A track is represented by a row of discs on each of its two lines. Costs one box test per track
/// and body, and for bodies near a track one query for each disc whose bounding box overlaps the
/// body's.
class TrackBodies {
 public:
  /// Adds the contact forces of this step of `dt` [s] to the machine `own`, on the track of its
  /// wheel with the index `wheel`, and to the bodies that the track touches. Precondition: the
  /// wheel has a track. `machine` is the index of `own`, and `bodies` has the bodies of all
  /// machines.
  void push(BulletMachine& own, std::size_t machine, std::size_t wheel,
            const ContactCandidates& bodies, btCollisionWorld& world, double dt);

 private:
  /// Discs that represent one track.
  struct Track {
    /// Positions of the discs along the track.
    std::vector<terramechanics::TrackStation> stations;
    /// Collision discs: for each station, one on each line.
    std::vector<Disc> discs;
    /// Width of the track [m].
    double width = 0;
  };
  /// Returns the discs of a track. They are made at the first call. `p_sprocket` is the sprocket's
  /// centre in the frame of the track's carrier link [m].
  Track& running_track(std::size_t machine, std::size_t wheel, const scene::Wheel& about,
                       const Vec3& p_sprocket);
  /// Collects in `near_` the bodies whose bounding boxes overlap that of the track. `X_WC` is the
  /// pose of the track's carrier link.
  void look_round(const BulletMachine& own, const Track& running_track, const Pose& X_WC,
                  const ContactCandidates& bodies);
  /// Finds the contacts of a track with the bodies in `near_` and stores them in `touches_`.
  void touch(Track& running_track, const Pose& X_WC, const scene::Wheel& about,
             btCollisionWorld& world);

  /// Bodies near the track that is being computed.
  std::vector<const MetBody*> near_;
  /// Contacts of the track that is being computed. Each refers to its body by the body's index in
  /// `near_`.
  std::vector<terramechanics::TrackTouch> touches_;
  /// Discs of each track, indexed by machine and wheel; without stations until the first use, and
  /// for wheels without a track.
  std::vector<std::vector<Track>> tracks_;
};

}  // namespace navvy::vehicle
