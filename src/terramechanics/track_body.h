// SPDX-License-Identifier: Apache-2.0
// Forces of rigid bodies (a kerb, a deck, a wall, another machine) on a crawler's track, by the
// same springs and shear as on ground.
#pragma once

#include <array>
#include <vector>

#include "terramechanics/track.h"
#include "terramechanics/tyre_body.h"

namespace navvy::terramechanics {

/// Disc that represents a piece of the track's path: idler, sprocket, and discs inside the lower
/// run at every roller and between them.
struct TrackStation {
  /// Centre in the carrier's frame [m].
  Vec3 p_C = Vec3::Zero();
  /// Radius to the outside of the track [m].
  double radius = 0;
  /// Length of track that the disc represents [m].
  double length = 0;
  /// Position along the path from the first disc [m].
  double along = 0;
};

/// Returns the discs from front to rear. Their spacing finds any body that reaches further between
/// two discs than a sixteenth of their radius.
std::vector<TrackStation> track_stations(const scene::Wheel& wheel, const Vec3& p_sprocket);

/// Number of lines on which a track meets bodies, each in the middle of half its width.
inline constexpr std::size_t kTrackLines = 2;

/// Contact of a body with a disc on one of the lines.
struct TrackTouch {
  BodyTouch at;
  std::size_t station = 0, line = 0;
  /// Index of the body. Contacts of one body share its weight.
  std::size_t body = 0;
};

/// Shear displacement of the shoes on bodies where they leave each disc, by line (ahead, left) [m].
using TrackBodyShear = std::vector<std::array<Vec2, kTrackLines>>;

/// Force of bodies on a track over a step.
struct TrackBodyForce {
  /// Forces on the track's carrier by contact [N]. Each body gets the opposite.
  std::vector<Vec3> f_W;
  /// Torque of the track on its sprocket, against the carrier [N m].
  double torque = 0;
};

/// Computes the force of bodies on a track over the next step dt [s] and advances `shear`.
/// `touches` are sorted by line and station.
///
/// A single contact is as stiff as a roller; all contacts of a flat floor together are as stiff as
/// all rollers, since contacts nearer than two rollers share the stiffness. If several bodies touch
/// one disc, all press and the one with the largest load also grips. Forces never pull.
TrackBodyForce track_body_force(const scene::Wheel& wheel,
                                const std::vector<TrackStation>& stations,
                                const TrackMotion& motion, const std::vector<TrackTouch>& touches,
                                double dt, TrackBodyShear& shear);

}  // namespace navvy::terramechanics
