// SPDX-License-Identifier: Apache-2.0
// What one track of a tyre (a tyre of a twin pair, or half of a single one) does where it touches, whatever it touches:
// carcass spring and bristles, shared by the laws on ground and on bodies.
#pragma once

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::terramechanics {

inline constexpr double kMaxDeflection = 0.25;  // of the radius: tread on the rim

/// Distance of the tracks' middles from the wheel's centre along the axle [m].
double track_offset(const scene::Wheel& tyre);

/// Spring and damper of the carcass [N], never pulling, bounded where the tread meets the rim. `share` of the wheel's
/// stiffness is this track's, `closing` the speed at which it is pressed in [m/s].
double radial_force(const scene::Wheel& tyre, double share, double deflection, double closing);

/// Stretches the bristle by the slip of this step and returns the force on the tyre (forward, left) [N], at most
/// `limit`. `rim_mass` [kg] is what the force accelerates: it bounds what an explicit step may do.
Vec2 bristle_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling, double limit,
                   double rim_mass, double dt, Vec2& bristle);

}  // namespace navvy::terramechanics
