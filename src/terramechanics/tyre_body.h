// SPDX-License-Identifier: Apache-2.0
// Force of a rigid body (a pipe, a kerb, a wall, another machine) on a tyre. It follows from the
// same spring and bristles as on the ground (tyre.h).
#pragma once

#include "terramechanics/tyre.h"

namespace navvy::terramechanics {

/// Contact of a rigid body with the round tread of a tyre, or with a disc of a track.
struct BodyTouch {
  /// Contact point on the body in the world frame [m].
  Vec3 p_W = Vec3::Zero();
  /// Unit normal in the world frame, pointing out of the body.
  Vec3 normal = Vec3::UnitZ();
  /// Penetration of the tread into the body along the normal [m].
  double depth = 0;
  /// Velocity of the body at `p_W` in the world frame [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Friction coefficient of the tyre or track on this body [-].
  double friction = 0.8;
  /// Inverse of the mass with which the body resists a force along the normal at `p_W` [1/kg]; 0 if
  /// the body cannot be moved.
  double inverse_mass = 0;
};

/// Returns the force of a body on the wheel at the contact point over the next step `dt` [s], in
/// the world frame [N]. The caller applies the opposite force to the body.
///
/// With a `bristle` (deflection forward and left [m]) the contact grips, and the bristle advances.
/// With a null `bristle` the contact slides without friction. Only one contact of a strip may grip.
///
/// The force never pulls. Contacts with light bodies are softer, so that an explicit step does not
/// throw the body away.
Vec3 tyre_body_force(const scene::Wheel& tyre, const TyreMotion& motion, const BodyTouch& touch,
                     double dt, Vec2* bristle);

}  // namespace navvy::terramechanics
