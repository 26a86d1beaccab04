// SPDX-License-Identifier: Apache-2.0
// Whether a machine stands or tips over: centre of mass against its feet.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Signed distance [m] of `p` from the border of the convex hull of `feet`, positive within; 0
/// where they span no area.
double support_margin(std::vector<Vec2> feet, const Vec2& p);

/// What tips a machine over the weakest edge of the polygon of its feet.
struct TippingLoad {
  double load = kNoTippingLoad;  ///< [kg]; 0 of a machine that tips without
  /// Unit, across that edge, seen from above; zero where no edge can tip.
  Vec2 outward = Vec2::Zero();
};

/// Mass that hangs at `load_point` and brings the centre of a machine of `mass` [kg] at `centre`
/// onto an edge, the least over all edges: m = M d / l with the distances of centre and load from
/// the edge's line, inside and outside (static tipping load, as [ISO 10567] defines it). All points
/// seen from above [m]: gravity is vertical, so that a slope counts by itself. Tyres and cylinders
/// do not give way.
TippingLoad tipping_load(std::vector<Vec2> feet, const Vec2& centre, double mass,
                         const Vec2& load_point);

/// Centre of mass of all links of machine `index` of the engine [m] in W; soil that it carries does
/// not count.
Vec3 centre_of_mass(const scene::Machine& machine, const PhysicsEngine& engine, int index);

/// How it stands after the last step. A foot is the lowest point of a wheel, whether it touches the
/// ground or not, an end of a crawler's lower run, or the lowest point of a collision shape of the
/// base that reaches as far down: a castor's ball, a skid. An axle that oscillates counts as
/// locked, or at its stop: before, the machine leans to it. The load hangs on the joint of the
/// bucket.
Stability stability(const scene::Machine& machine, const PhysicsEngine& engine, int index);

}  // namespace navvy::vehicle
