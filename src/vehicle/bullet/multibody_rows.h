// SPDX-License-Identifier: Apache-2.0
// What our own constraint rows between a multibody and the world, or another multibody, have in
// common.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace navvy::vehicle {

/// Rows on one multibody, or between two; the impulses are read back after the solver ran.
class MultibodyRows : public btMultiBodyConstraint {
 public:
  // The engine solves all in one group and draws nothing; Bullet's world would ask.
  int getIslandIdA() const override { return -1; }
  int getIslandIdB() const override { return -1; }
  void debugDraw(btIDebugDraw*) override {}

 protected:
  /// @param link Bullet's link, -1: the base
  MultibodyRows(btMultiBody* body, int link, int rows);
  MultibodyRows(btMultiBody* body, int link, btMultiBody* other, int link_of_other, int rows);
  /// Makes room for one Jacobian row of all freedoms a row; call it once the bodies have their
  /// size.
  void finalizeMultiDof() override;
  /// Adds a row: what jacobianA(row) tells of the body's velocity, and jacobianB(row) of the
  /// other's, shall together become `velocity` within [low, high] impulse.
  void add_row(int row, double velocity, double low, double high, btMultiBodyConstraintArray& rows,
               btMultiBodyJacobianData& data, const btContactSolverInfo& info);
  /// Adds a row that keeps `gap` [rad|m] open, whose growth the Jacobians of the row tell and which
  /// changes by `rate` [rad/s|m/s] now: from the step on in which it could close, which may use it
  /// up, and leaves an overrun slowly. No row before.
  void add_stop(int row, double gap, double rate, btMultiBodyConstraintArray& rows,
                btMultiBodyJacobianData& data, const btContactSolverInfo& info);
};

}  // namespace navvy::vehicle
