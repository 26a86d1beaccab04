// SPDX-License-Identifier: Apache-2.0
// Grip of a track's shoes, shared by the laws on ground and on bodies.
#pragma once

#include "core/math.h"

namespace navvy::terramechanics {

// [m] Shear compliance of a shoe on a firm surface (U).
inline constexpr double kFirmShear = 0.005;
// Largest shear in units of K: 99.8 % of the strength is mobilised there.
inline constexpr double kMostShear = 6;
// [m/s] Faster shoes carry their shear away, which damps without a further term.
inline constexpr double kTrackRest = 0.1;
// [m/s] Rolling resistance reverses its sign over this speed.
inline constexpr double kTrackRoll = 0.05;

/// Largest shear force of a contact [N], and the displacement at which 63 % of it is
/// mobilised [m].
struct TrackGrip {
  double most = 0, K = 0;
};

/// Returns the grip of a contact of `most` [N]. Raises K where an explicit step is unstable with
/// the stiffness with `mass` [kg].
TrackGrip track_grip(double most, double K, double mass, double dt);

/// Returns the shear force (ahead, left) [N] on the shoes of a contact with the slip velocity
/// `slip` [m/s] and the displacement `shear` [m], for a track that runs at `track_speed` [m/s].
/// `mass` is the mass that the force accelerates [kg].
Vec2 track_shear_force(const TrackGrip& grip, const Vec2& shear, const Vec2& slip,
                       double track_speed, double mass, double dt);

/// Advances the shear of one segment of `length` [m] by a step. Shoes leave with their shear, and
/// entering shoes bring `before`. The update is implicit and stable at any speed. Limits the shear
/// to `most` [m].
/// @return the shear in the middle of the segment.
Vec2 carry_shear(const Vec2& before, const Vec2& slip, double length, double track_speed,
                 double most, double dt, Vec2& shear);

}  // namespace navvy::terramechanics
