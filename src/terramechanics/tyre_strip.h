// SPDX-License-Identifier: Apache-2.0
// Forces of one contact strip of a tyre (one tyre of a twin pair, or one half of a single tyre):
// carcass spring and tread bristles. Contacts with the ground and with rigid bodies share them.
#pragma once

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::terramechanics {

/// Largest radial deflection as a share of the tyre's radius [-], at which the tread meets the rim.
inline constexpr double kMaxDeflection = 0.25;

/// Returns the distance [m] along the axle from the wheel's centre to the middle of either contact
/// strip.
double track_offset(const scene::Wheel& tyre);

/// Returns the radial force [N] of a contact strip's carcass spring and damper. It never pulls and
/// is limited where the tread meets the rim.
///
/// `share` is the strip's part of the wheel's stiffness and damping [-], `deflection` its radial
/// deflection [m], `closing` the rate of that deflection [m/s], positive while it grows.
double radial_force(const scene::Wheel& tyre, double share, double deflection, double closing);

/// Advances the deflection `bristle` (forward, left) [m] of a strip's tread by one step `dt` [s]
/// and returns the tangential force on the tyre (forward, left) [N], at most `limit` [N].
///
/// `share` is the strip's part of the wheel's stiffness and damping [-], `slip` the velocity of the
/// tread over the ground (forward, left) [m/s], `rolling` the speed of the rim [m/s]. `rim_mass` is
/// the mass that the force accelerates [kg]; it limits the stiffness so that an explicit step is
/// stable.
Vec2 bristle_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                   double limit, double rim_mass, double dt, Vec2& bristle);

/// Shear law of the soil under one contact strip of a tyre.
struct TrackShear {
  /// Largest tangential force of the soil [N].
  double limit = 0;
  /// Shear displacement K at which 63 % of `limit` is mobilised [m], > 0.
  double janosi_k = 0;
  /// Half length l of the contact patch [m]. Rolling over this distance replaces the sheared soil
  /// by fresh soil.
  double half_length = 0;
};

/// Returns the tangential force on a strip (forward, left) [N] on soil, and advances `bristle` [m]
/// and `sheared` [m] by one step `dt` [s]. The other parameters are those of bristle_force().
///
/// The bristle is in series with soil that yields once its mobilised strength is reached:
///
///   F = -k u - c v_s,  |F| <= limit (1 - exp(-j / K)),  dj/dt = yielding - |V| / l j
///
/// u is the bristle's deflection, v_s the slip velocity, V the rolling speed, and j = `sheared` the
/// soil's displacement, which TyreState stores. In steady rolling at a small slip s, j = s l, the
/// mean displacement over a patch of length 2 l. Soil that has yielded and is at rest still resists
/// with its mobilised strength. As K approaches 0, the law becomes bristle_force().
Vec2 shear_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                 const TrackShear& soil, double rim_mass, double dt, Vec2& bristle,
                 double& sheared);

}  // namespace navvy::terramechanics
