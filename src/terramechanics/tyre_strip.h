// SPDX-License-Identifier: Apache-2.0
// Contact strip of a tyre (a tyre of a twin pair, or half of a single tyre): carcass spring and
// bristles, shared by the laws on ground and on bodies.
#pragma once

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::terramechanics {

// Share of the radius at which the tread meets the rim.
inline constexpr double kMaxDeflection = 0.25;

/// Returns the distance of the strips' middles from the wheel's centre along the axle [m].
double track_offset(const scene::Wheel& tyre);

/// Returns the force of the carcass spring and damper [N]. Never pulls; limited where the tread
/// meets the rim. `share` is the strip's part of the wheel's stiffness, `closing` the compression
/// speed [m/s].
double radial_force(const scene::Wheel& tyre, double share, double deflection, double closing);

/// Advances the bristle by the slip of this step and returns the force on the tyre (forward, left)
/// [N], at most `limit`. `rim_mass` [kg] is the mass that the force accelerates; it limits an
/// explicit step.
Vec2 bristle_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                   double limit, double rim_mass, double dt, Vec2& bristle);

/// Shear of the soil under a contact strip.
struct TrackShear {
  /// Largest force along the ground [N].
  double limit = 0;
  /// Displacement at which 63 % of it is mobilised [m].
  double janosi_k = 0;
  /// Half length of the patch: the soil under it is replaced over this distance [m].
  double half_length = 0;
};

/// Computes the same on soil: the bristle in series with soil that yields once its mobilised
/// strength is reached,
///
///   F = -k u - c v_s,  |F| <= limit (1 - exp(-j / K)),  dj/dt = yielding - |V| / l j
///
/// with `sheared` j [m], stored in TyreState. In steady rolling at a small slip s, j = s l: the
/// mean displacement over a patch of length 2 l. Soil at rest that has yielded holds what it bore.
/// K is above 0; towards 0 the law becomes bristle_force.
Vec2 shear_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                 const TrackShear& soil, double rim_mass, double dt, Vec2& bristle,
                 double& sheared);

}  // namespace navvy::terramechanics
