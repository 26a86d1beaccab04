// SPDX-License-Identifier: Apache-2.0
// Constraint rows on one joint of a multibody: a motor with unequal bounds, and the joint's limits.
#pragma once

#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Motor of one revolute or prismatic joint. Reaches `velocity` within [low, high] impulse, and
/// keeps the joint between its limits at any cost; the impulses are read back after the solver ran.
class ServoConstraint final : public MultibodyRows {
 public:
  /// @param link Bullet's link of the joint; lower, upper: its stops [rad|m], looked at when
  /// `has_limits`.
  ServoConstraint(btMultiBody* body, int link, bool has_limits, double lower, double upper);

  /// For the coming step: velocity to reach [rad/s|m/s], bounds of the motor's impulse [N m s|N s].
  /// Low = high: no motor, the joint is free but for its stops.
  void command(double velocity, double low, double high) {
    velocity_ = velocity;
    low_ = low;
    high_ = high;
  }
  /// Of the motor row in the last step [N m s|N s].
  double motor_impulse() { return getAppliedImpulse(0); }
  /// Of both limit rows, signed along the joint.
  double limit_impulse() { return getAppliedImpulse(1) - getAppliedImpulse(2); }

  // Called by Bullet: Jacobians once, rows in every step.
  void finalizeMultiDof() override;
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  bool has_limits_;
  double lower_, upper_;
  double velocity_ = 0, low_ = 0, high_ = 0;
};

}  // namespace navvy::vehicle
