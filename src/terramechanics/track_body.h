// SPDX-License-Identifier: Apache-2.0
// Forces of rigid bodies (a kerb, a deck, a wall, another machine) on a crawler's track. They
// follow from the same springs and shear law as on the ground (track.h).
#pragma once

#include <array>
#include <vector>

#include "terramechanics/track.h"
#include "terramechanics/tyre_body.h"

namespace navvy::terramechanics {

/// Disc that represents a piece of a track's path in contacts with rigid bodies. The idler, the
/// sprocket and every roller have one, and further discs fill the lower run between them.
struct TrackStation {
  /// Centre of the disc in the frame of the track's carrier link [m].
  Vec3 p_C = Vec3::Zero();
  /// Radius of the disc, up to the outside of the track [m].
  double radius = 0;
  /// Length of the piece of track that the disc represents [m].
  double length = 0;
  /// Position of the disc along the track's path, from the first disc [m].
  double along = 0;
};

/// Returns the discs of the track of the sprocket `wheel`, from front to rear. `p_sprocket` is the
/// sprocket's centre in the carrier's frame [m].
///
/// The discs are so close that a body cannot reach further between two of them than a sixteenth of
/// their radius without touching one.
std::vector<TrackStation> track_stations(const scene::Wheel& wheel, const Vec3& p_sprocket);

/// Number of lines along the track on which it touches bodies. The track is divided into this many
/// strips of equal width, with one line in the middle of each.
inline constexpr std::size_t kTrackLines = 2;

/// Contact of a rigid body with one disc of a track.
struct TrackTouch {
  /// Point, normal, depth and velocity of the contact.
  BodyTouch at;
  /// Index of the disc in the result of track_stations(), and index of the line that it is on (less
  /// than kTrackLines).
  std::size_t station = 0, line = 0;
  /// Index of the body, chosen by the caller. Contacts with equal indices share that body's mass.
  std::size_t body = 0;
};

/// Shear displacement (forward, left) of a track's shoes relative to the bodies that they touch
/// [m]. There is one entry per disc and line: the displacement of the shoes that leave the disc's
/// piece of track.
using TrackBodyShear = std::vector<std::array<Vec2, kTrackLines>>;

/// Force of rigid bodies on a track over one step.
struct TrackBodyForce {
  /// Forces in the world frame on the track's carrier link, one per contact [N]. The caller applies
  /// the opposite force to the body.
  std::vector<Vec3> f_W;
  /// Torque of the track on its sprocket, about the sprocket's axis [N m]; positive drives the
  /// sprocket forward. The opposite torque acts on the carrier link.
  double torque = 0;
};

/// Returns the force of rigid bodies on the track of the sprocket `wheel` over the next step `dt`
/// [s], and advances `shear`, which has one entry per station.
///
/// `stations` is the result of track_stations() for this track. `touches` must be sorted by line,
/// then by station.
///
/// A single contact on one line is half as stiff as a roller, so a body that touches both lines
/// meets the stiffness of one roller. Contacts on one line that are closer to each other than the
/// rollers are share this stiffness; a flat floor is thus as stiff as all rollers together. If
/// several bodies touch one disc, all of them press on it, but only the one with the largest load
/// also grips. Contact forces never pull.
TrackBodyForce track_body_force(const scene::Wheel& wheel,
                                const std::vector<TrackStation>& stations,
                                const TrackMotion& motion, const std::vector<TrackTouch>& touches,
                                double dt, TrackBodyShear& shear);

}  // namespace navvy::terramechanics
