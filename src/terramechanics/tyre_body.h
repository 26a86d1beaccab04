// SPDX-License-Identifier: Apache-2.0
// Tyre on a rigid body (a pipe, a kerb, a wall, another machine), by the same spring and bristles
// as on ground.
#pragma once

#include "terramechanics/tyre.h"

namespace navvy::terramechanics {

/// Contact of a body with the round tread of a contact strip.
struct BodyTouch {
  /// Contact point on the body [m].
  Vec3 p_W = Vec3::Zero();
  /// Unit normal, out of the body.
  Vec3 normal = Vec3::UnitZ();
  /// Penetration of the tread along the normal [m].
  double depth = 0;
  /// Velocity of the body at p_W [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Friction of the tyre on this body [-].
  double friction = 0.8;
  /// Inverse mass of the body at the contact along the normal [1/kg]; 0: immovable.
  double inverse_mass = 0;
};

/// Computes the force on the wheel at p_W over the next step dt [s]; the body gets the opposite.
/// With a bristle the contact also grips, and the bristle advances; without one it slides freely.
/// Only one contact of a strip grips.
///
/// Never pulls. Contacts with light bodies are softer, since an explicit step must not throw the
/// body away.
Vec3 tyre_body_force(const scene::Wheel& tyre, const TyreMotion& motion, const BodyTouch& touch,
                     double dt, Vec2* bristle);

}  // namespace navvy::terramechanics
