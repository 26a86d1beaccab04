// SPDX-License-Identifier: Apache-2.0
// How the shoes of a belt grip, whatever they stand on: shared by the laws on ground and on bodies.
#pragma once

#include "core/math.h"

namespace navvy::terramechanics {

inline constexpr double kFirmShear = 0.005;  // [m] give of a shoe on what is firm (U)
// Of K: 99.8 % of the strength; what is sheared further forgets no longer
inline constexpr double kMostShear = 6;
// [m/s] faster shoes carry their stretch away, which damps by itself
inline constexpr double kTrackRest = 0.1;
inline constexpr double kTrackRoll = 0.05;  // [m/s] resistance turns round over this

/// What a contact bears in shear, at most [N], and the displacement [m] at which 63 % of it are
/// mobilised.
struct TrackGrip {
  double most = 0, K = 0;
};

/// K of a contact of `most` [N], no stiffer than what a step can bear with `mass` [kg].
TrackGrip track_grip(double most, double K, double mass, double dt);

/// Shear force (ahead, left) [N] on the shoes of a contact that slip by `slip` [m/s] and are
/// sheared by `shear` [m], of a belt that runs at `track_speed` [m/s]; `mass` is what it
/// accelerates.
Vec2 track_shear_force(const TrackGrip& grip, const Vec2& shear, const Vec2& slip,
                       double track_speed, double mass, double dt);

/// What shears on goes out with the shoes, and those that come in bring `before`: one segment of
/// `length` [m] a step on, implicitly, so that no speed is too large. No further than `most` [m].
/// @return what is sheared in its middle.
Vec2 carry_shear(const Vec2& before, const Vec2& slip, double length, double track_speed,
                 double most, double dt, Vec2& shear);

}  // namespace navvy::terramechanics
