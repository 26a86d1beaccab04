// SPDX-License-Identifier: Apache-2.0
// Belt of a crawler on bodies: a kerb, a deck, a wall, another machine. The same springs and shear
// as on ground.
#pragma once

#include <array>
#include <vector>

#include "terramechanics/track.h"
#include "terramechanics/tyre_body.h"

namespace navvy::terramechanics {

/// A disc that stands for a piece of the belt's path: idler and sprocket themselves, and along the
/// lower run discs that touch it from within, at every roller and between them.
struct TrackStation {
  Vec3 p_C = Vec3::Zero();  ///< middle, in the carrier [m]
  double radius = 0;        ///< to the belt's outside [m]
  double length = 0;        ///< of the belt that it stands for [m]
  double along = 0;         ///< of the path, from the first one [m]
};

/// From front to rear. They lie so close that what reaches between two is felt within a sixteenth
/// of their radius.
std::vector<TrackStation> track_stations(const scene::Wheel& wheel, const Vec3& p_sprocket);

/// A belt meets bodies on two lines, each in the middle of half its width.
inline constexpr std::size_t kTrackLines = 2;

/// Where a body reaches into a station on one of the lines.
struct TrackTouch {
  BodyTouch at;
  std::size_t station = 0, line = 0;
  std::size_t body = 0;  ///< which one: touches of one body share what it weighs
};

/// How far shoes are sheared on bodies where they leave each station, by line (ahead, left) [m].
using TrackBodyShear = std::vector<std::array<Vec2, kTrackLines>>;

struct TrackBodyForce {
  std::vector<Vec3> f_W;  ///< on the belt's carrier, by touch [N]; the body gets the opposite
  double torque = 0;      ///< of the belt on its sprocket, against the carrier [N m]
};

/// Force of bodies on a belt over the next step dt [s]; moves the shear on. `touches` by line and
/// station, as they come.
///
/// A touch alone is as stiff as a roller, all of a flat floor together as all rollers: touches
/// nearer than two rollers share. Several bodies at one station all press, the one that presses
/// most also grips. Never pulls.
TrackBodyForce track_body_force(const scene::Wheel& wheel,
                                const std::vector<TrackStation>& stations,
                                const TrackMotion& motion, const std::vector<TrackTouch>& touches,
                                double dt, TrackBodyShear& shear);

}  // namespace navvy::terramechanics
