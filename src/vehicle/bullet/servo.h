// SPDX-License-Identifier: Apache-2.0
// Constraint rows for one joint of a multibody: a motor whose limits may differ between both
// directions, and the joint's stops.
#pragma once

#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

class MechanismRows;

/// Motor of one revolute or prismatic joint. It brings the joint to a given velocity with a limited
/// impulse, and keeps the joint between its stops with unlimited impulse. After the solver has run,
/// the impulse of the motor can be read back.
class ServoConstraint final : public MultibodyRows {
 public:
  /// Allocates the rows for one joint.
  /// @param link Bullet's index of the joint's child link
  /// @param lower, upper positions of the stops [rad|m], used only if `has_limits`
  ServoConstraint(btMultiBody* body, int link, bool has_limits, double lower, double upper);

  /// Sets the velocity to reach [rad/s|m/s] and the limits `low` and `high` of the motor's impulse
  /// [N m s|N s] for the coming step. With equal limits there is no motor: the joint moves freely
  /// between its stops.
  void command(double velocity, double low, double high) {
    velocity_ = velocity;
    low_ = low;
    high_ = high;
  }
  /// Makes the motor move the joint together with what `mechanism` couples it to. The mechanism
  /// must exist as long as this object.
  void couple(const MechanismRows& mechanism) { mechanism_ = &mechanism; }
  /// Returns the impulse of the motor in the last step [N m s|N s].
  double motor_impulse() { return getAppliedImpulse(0); }

  /// Sets the Jacobians of all rows. Bullet calls it once.
  void finalizeMultiDof() override;
  /// Adds the rows of the motor and of the stops to the solver. Bullet calls it in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Adds the row of the motor of a joint that a mechanism couples to others.
  void add_coupled(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                   const btContactSolverInfo& info);

  /// Rows of the machine's gears and loops, or null.
  const MechanismRows* mechanism_ = nullptr;
  /// True if the joint has stops.
  bool has_limits_;
  /// Positions of the stops [rad|m].
  double lower_, upper_;
  /// Velocity to reach [rad/s|m/s] and limits of the motor's impulse [N m s|N s] in the coming
  /// step.
  double velocity_ = 0, low_ = 0, high_ = 0;
};

}  // namespace navvy::vehicle
