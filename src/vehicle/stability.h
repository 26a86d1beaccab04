// SPDX-License-Identifier: Apache-2.0
// Stability of a machine against tipping over: its centre of mass relative to its support polygon.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Returns the signed distance [m] of the point `p` from the boundary of the support polygon, the
/// convex hull of `support_points`; positive inside, negative outside. Returns 0 if the points span
/// no area.
double support_margin(std::vector<Vec2> support_points, const Vec2& p);

/// Load that tips a machine over the weakest edge of its support polygon.
struct TippingLoad {
  /// Mass of the load [kg]; 0 for a machine that tips without a load, kNoTippingLoad if no load can
  /// tip it.
  double load = kNoTippingLoad;
  /// Horizontal unit vector in the world frame across that edge, pointing away from the machine;
  /// zero if no edge can tip.
  Vec2 outward = Vec2::Zero();
};

/// Returns the smallest load at `load_point` that tips a machine of `mass` M [kg], with its centre
/// of mass at `centre`, over an edge of the support polygon, the convex hull of `support_points`,
/// and the direction across that edge. All points are horizontal positions in the world frame [m].
///
/// The load moves the common centre of mass onto an edge: m = M d / l, where d is the distance of
/// `centre` inside the edge and l that of `load_point` outside it (static tipping load as in
/// [ISO 10567]). Since gravity is vertical, slopes are included. Tyres and cylinders count as
/// rigid.
TippingLoad tipping_load(std::vector<Vec2> support_points, const Vec2& centre, double mass,
                         const Vec2& load_point);

/// Returns the factor by which the force `f` [N] on a machine at the point `p` must grow to tip the
/// machine over an edge of its support polygon: 0 for a machine that tips without it, infinity if
/// no factor tips it.
///
/// `support_points`, `centre` and `p` are positions in the world frame [m], `ground` is the height
/// of the support points [m], and `weight` is the machine's [N]. Tyres and cylinders count as
/// rigid. A force straight down gives tipping_load().
double tipping_factor(std::vector<Vec2> support_points, double ground, const Vec2& centre,
                      double weight, const Vec3& p, const Vec3& f);

/// Returns the points on which `machine` stands while its links have the poses `X_WL`, in the order
/// of machine.links: the support points of stability(), in the world frame [m].
std::vector<Vec3> support_points(const scene::Machine& machine, const std::vector<Pose>& X_WL);

/// Returns the centre of mass of all links of `machine` while they have the poses `X_WL`, in the
/// order of machine.links, in the world frame [m].
Vec3 centre_of_mass(const scene::Machine& machine, const std::vector<Pose>& X_WL);

/// Returns the centre of mass of all links of `machine`, which is machine `index` of `engine`, in
/// the world frame [m]. The soil that it carries is not included.
Vec3 centre_of_mass(const scene::Machine& machine, const PhysicsEngine& engine, int index);

/// Returns the stability of `machine`, which is machine `index` of `engine`, after the last step.
///
/// The support points are: the lowest point of every wheel, whether it touches the ground or not;
/// both ends of the lower run of a crawler's track; and the lowest points of collision shapes of
/// the base link, and of links fixed to it or on a ball joint, that reach as far down as the
/// wheels, such as a caster's ball or a skid. An oscillating axle counts as locked, so the result
/// is valid while the axle is locked or at its stop. The tipping load hangs on the bucket's joint.
Stability stability(const scene::Machine& machine, const PhysicsEngine& engine, int index);

}  // namespace navvy::vehicle
