// SPDX-License-Identifier: Apache-2.0
// Stability of a machine against tipping: centre of mass against its feet.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Returns the signed distance [m] of `p` from the boundary of the convex hull of `feet`, positive
/// inside; 0 if they span no area.
double support_margin(std::vector<Vec2> feet, const Vec2& p);

/// Load that tips a machine over the weakest edge of the polygon of its feet.
struct TippingLoad {
  /// Load [kg]; 0 for a machine that tips without load.
  double load = kNoTippingLoad;
  /// Unit vector across that edge, seen from above; zero if no edge can tip.
  Vec2 outward = Vec2::Zero();
};

/// Returns the mass at `load_point` that moves the centre of a machine of `mass` [kg] at `centre`
/// onto an edge, the minimum over all edges: m = M d / l with the distances of centre and load from
/// the edge's line, inside and outside (static tipping load as in [ISO 10567]). All points are seen
/// from above [m]: gravity is vertical, so slopes are included. Tyres and cylinders are rigid.
TippingLoad tipping_load(std::vector<Vec2> feet, const Vec2& centre, double mass,
                         const Vec2& load_point);

/// Returns the centre of mass of all links of machine `index` of the engine [m] in W, without the
/// soil it carries.
Vec3 centre_of_mass(const scene::Machine& machine, const PhysicsEngine& engine, int index);

/// Returns the stability after the last step.
///
/// A foot is the lowest point of a wheel, whether it touches the ground or not, an end of a
/// crawler's lower run, or the lowest point of a collision shape of the base that reaches as far
/// down: a caster's ball, a skid. An oscillating axle counts as locked, or at its stop: the machine
/// leans until then. The load hangs on the joint of the bucket.
Stability stability(const scene::Machine& machine, const PhysicsEngine& engine, int index);

}  // namespace navvy::vehicle
