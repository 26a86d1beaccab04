// SPDX-License-Identifier: Apache-2.0
// How full a bucket is dug.
#pragma once

#include "control/arm_kinematics.h"
#include "heightfield/layered_ground.h"
#include "scene/soil.h"

namespace navvy::control {

/// Returns true for soil with a cohesion below 1.5 kPa, as sand, gravel and broken rock, which
/// stand at their angle of repose only.
bool is_cohesionless(const scene::Soil& soil);

/// Returns the bucket fill factor that a dig aims at in `soil` unless its scene sets one: loose
/// volume over the heaped capacity [-].
///
/// The kind of soil follows from its values, in this order: broken rock swells by half or more
/// (0.7); sand and gravel have hardly any cohesion and stand in a heap on the bucket's mouth at
/// their angle of repose, where the heaped capacity has a slope of 1:1; hard clay has little
/// friction and a cohesion from 15 kPa on (0.9); all other soil, moist clay too, counts as loam
/// (1.05).
double usual_fill(const scene::Soil& soil, const ArmKinematics& arm);

/// Returns the soil of the surface at `p` (x, y in W [m]); a default one outside of the site.
scene::Soil surface_soil(const heightfield::Ground& ground, const Vec2& p);

}  // namespace navvy::control
