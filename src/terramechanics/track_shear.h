// SPDX-License-Identifier: Apache-2.0
// Grip of a track's shoes: the shear law that contacts with the ground (track.h) and with rigid
// bodies (track_body.h) share.
#pragma once

#include "core/math.h"

namespace navvy::terramechanics {

/// Shear displacement K of a shoe on a firm surface [m] at which 63 % of its friction is mobilised.
/// Typical value, unverified (U).
inline constexpr double kFirmShear = 0.005;
/// Largest stored shear displacement in units of K [-]; 99.8 % of the strength is mobilised there.
inline constexpr double kMostShear = 6;
/// Track speed [m/s] over which the extra damping of a standing track fades out. Faster shoes carry
/// their shear away, which damps without a further term.
inline constexpr double kTrackRest = 0.1;
/// Track speed [m/s] over which the rolling resistance changes smoothly from one sign to the other.
inline constexpr double kTrackRoll = 0.05;

/// Shear law of one contact of a track.
struct TrackGrip {
  /// Largest shear force `most` of the contact [N], and the shear displacement `K` at which 63 % of
  /// it is mobilised [m].
  double most = 0, K = 0;
};

/// Returns the grip of a contact whose largest shear force is `most` [N], 63 % of which is
/// mobilised at the shear displacement `K` [m]. K is increased where the contact would be too stiff
/// for an explicit step `dt` [s] with the accelerated `mass` [kg].
TrackGrip track_grip(double most, double K, double mass, double dt);

/// Returns the shear force (forward, left) [N] on the shoes of a contact, at most grip.most.
///
/// `shear` is their shear displacement [m], `slip` their velocity over the ground [m/s] (both
/// forward, left), `track_speed` the speed of the track over its rollers [m/s], and `mass` the mass
/// that the force accelerates [kg].
Vec2 track_shear_force(const TrackGrip& grip, const Vec2& shear, const Vec2& slip,
                       double track_speed, double mass, double dt);

/// Advances `shear`, the shear displacement (forward, left) [m] at the trailing end of a segment of
/// `length` [m], by one step `dt` [s].
///
/// Shoes leave the segment with `shear` and enter it with `before` [m]; `slip` is their velocity
/// over the ground [m/s]. The implicit update is stable at any `track_speed` [m/s]. It limits
/// `shear` to the magnitude `most` [m].
/// @return the shear displacement in the middle of the segment [m].
Vec2 carry_shear(const Vec2& before, const Vec2& slip, double length, double track_speed,
                 double most, double dt, Vec2& shear);

}  // namespace navvy::terramechanics
