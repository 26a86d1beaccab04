// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/tyre_body.h"

#include <algorithm>

#include "terramechanics/tyre_strip.h"

namespace navvy::terramechanics {

// All velocities are relative to the body.
Vec3 tyre_body_force(const scene::Wheel& tyre, const TyreMotion& motion, const BodyTouch& touch,
                     double dt, Vec2* bristle) {
  const Vec3 axis = motion.X_WWheel.linear().col(1);
  const Vec3 p = touch.p_W - motion.X_WWheel.translation();
  const Vec3 v_carrier = motion.v_W + motion.w_W.cross(p) - touch.v_W;
  const Vec3 v_rim = motion.spin * axis.cross(p);
  // Body and wheel are in series: an explicit step is stable while k dt^2 and c dt are below the
  // mass that they move.
  scene::Wheel soft = tyre;
  if (touch.inverse_mass > 0) {
    soft.stiffness = std::min(tyre.stiffness, 0.4 / (touch.inverse_mass * dt * dt));
    soft.damping = std::min(tyre.damping, 0.6 / (touch.inverse_mass * dt));
  }
  const double deflection = std::min(touch.depth, kMaxDeflection * tyre.radius);
  const double normal_force = radial_force(soft, 0.5, deflection, -touch.normal.dot(v_carrier));
  if (bristle == nullptr) return normal_force * touch.normal;

  // Ahead in the plane of the contact. A contact from the side has no direction of its own, so use
  // the wheel's.
  Vec3 ahead = axis.cross(touch.normal);
  if (ahead.norm() < 0.05) ahead = motion.X_WWheel.linear().col(0);
  ahead = (ahead - ahead.dot(touch.normal) * touch.normal).normalized();
  const Vec3 left = touch.normal.cross(ahead);
  const Vec3 v_slip = v_carrier + v_rim;
  const double rim_mass = motion.spin_inertia / (tyre.radius * tyre.radius);
  const double mass =
      touch.inverse_mass > 0 ? std::min(rim_mass, 1 / touch.inverse_mass) : rim_mass;
  const Vec2 f =
      bristle_force(soft, 0.5, Vec2(v_slip.dot(ahead), v_slip.dot(left)), -v_rim.dot(ahead),
                    touch.friction * normal_force, mass, dt, *bristle);
  return normal_force * touch.normal + f.x() * ahead + f.y() * left;
}

}  // namespace navvy::terramechanics
