// SPDX-License-Identifier: Apache-2.0
// Whether a machine stands or tips over: centre of mass against its feet.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "vehicle/engine.h"

namespace navvy::vehicle {

/// Signed distance [m] of `p` from the border of the convex hull of `feet`, positive within; 0 where they span no area.
double support_margin(std::vector<Vec2> feet, const Vec2& p);

/// Centre of mass of all links of machine `index` of the engine [m] in W; soil that it carries does not count.
Vec3 centre_of_mass(const scene::Machine& machine, const Engine& engine, int index);

/// How it stands after the last step. A foot is the lowest point of a wheel, whether it touches the ground or not, or
/// of a collision shape of the base that reaches as far down: a castor's ball, a skid.
Stability stability(const scene::Machine& machine, const Engine& engine, int index);

}  // namespace navvy::vehicle
