// SPDX-License-Identifier: Apache-2.0
// Constraint rows on one joint of a multibody: a motor with unequal limits, and the joint's stops.
#pragma once

#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Motor of one revolute or prismatic joint. Reaches `velocity` with an impulse in [low, high], and
/// keeps the joint between its stops with unlimited impulse. The impulses are read back after the
/// solver ran.
class ServoConstraint final : public MultibodyRows {
 public:
  /// Adds the rows.
  /// @param link Bullet's link of the joint
  /// @param lower, upper stops [rad|m], used if `has_limits`
  ServoConstraint(btMultiBody* body, int link, bool has_limits, double lower, double upper);

  /// Sets the velocity to reach [rad/s|m/s] and the limits of the motor's impulse [N m s|N s] for
  /// the coming step. With low = high there is no motor: the joint is free between its stops.
  void command(double velocity, double low, double high) {
    velocity_ = velocity;
    low_ = low;
    high_ = high;
  }
  /// Returns the impulse of the motor in the last step [N m s|N s].
  double motor_impulse() { return getAppliedImpulse(0); }

  // Bullet calls these: Jacobians once, rows in every step.
  void finalizeMultiDof() override;
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  bool has_limits_;
  double lower_, upper_;
  double velocity_ = 0, low_ = 0, high_ = 0;
};

}  // namespace navvy::vehicle
