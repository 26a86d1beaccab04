// SPDX-License-Identifier: Apache-2.0
// Tyre on a body: a pipe, a kerb, a wall, another machine. The same spring and bristles as on
// ground.
#pragma once

#include "terramechanics/tyre.h"

namespace navvy::terramechanics {

/// Where a body reaches into a track's round tread.
struct BodyTouch {
  Vec3 p_W = Vec3::Zero();      ///< on the body [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit, out of the body
  double depth = 0;             ///< of the tread in the body along the normal [m]
  Vec3 v_W = Vec3::Zero();      ///< of the body at p_W [m/s]
  double friction = 0.8;        ///< tyre on this body [-]
  /// Of the body there along the normal [1/kg]; 0: it does not give way.
  double inverse_mass = 0;
};

/// Force on the wheel at p_W over the next step dt [s]; the body gets its opposite. With a bristle
/// it also grips, and moves the bristle; without one it slides freely: only one touch of a track
/// grips.
///
/// Never pulls. What stands on something light is pressed less stiffly than on rock, as an explicit
/// step must not throw it away.
Vec3 tyre_body_force(const scene::Wheel& tyre, const TyreMotion& motion, const BodyTouch& touch,
                     double dt, Vec2* bristle);

}  // namespace navvy::terramechanics
