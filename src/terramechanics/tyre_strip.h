// SPDX-License-Identifier: Apache-2.0
// What one track of a tyre (a tyre of a twin pair, or half of a single one) does where it touches,
// whatever it touches: carcass spring and bristles, shared by the laws on ground and on bodies.
#pragma once

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::terramechanics {

inline constexpr double kMaxDeflection = 0.25;  // of the radius: tread on the rim

/// Distance of the tracks' middles from the wheel's centre along the axle [m].
double track_offset(const scene::Wheel& tyre);

/// Spring and damper of the carcass [N], never pulling, bounded where the tread meets the rim.
/// `share` of the wheel's stiffness is this track's, `closing` the speed at which it is pressed in
/// [m/s].
double radial_force(const scene::Wheel& tyre, double share, double deflection, double closing);

/// Stretches the bristle by the slip of this step and returns the force on the tyre (forward, left)
/// [N], at most `limit`. `rim_mass` [kg] is what the force accelerates: it bounds what an explicit
/// step may do.
Vec2 bristle_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                   double limit, double rim_mass, double dt, Vec2& bristle);

/// What soil under a track does when it is sheared.
struct TrackShear {
  double limit = 0;        ///< largest force along the ground [N]
  double janosi_k = 0;     ///< displacement at which 63 % of it is mobilised [m]
  double half_length = 0;  ///< of the patch: fresh soil comes under it within this way [m]
};

/// The same on soil: the bristle in series with soil that yields once its mobilised strength is
/// reached,
///
///   F = -k u - c v_s,  |F| <= limit (1 - exp(-j / K)),  dj/dt = yielding - |V| / l j
///
/// with `sheared` j [m], kept in TyreState. Rolling steadily at a small slip s, j = s l: the mean
/// displacement over a patch of length 2 l. Standing soil that has yielded holds what it bore. K is
/// above 0; towards 0 it is bristle_force.
Vec2 shear_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                 const TrackShear& soil, double rim_mass, double dt, Vec2& bristle,
                 double& sheared);

}  // namespace navvy::terramechanics
