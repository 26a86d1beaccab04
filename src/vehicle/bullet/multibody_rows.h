// SPDX-License-Identifier: Apache-2.0
// Common base of our constraint rows between a multibody and the world, or another multibody.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace navvy::vehicle {

/// Adds rows to one multibody, or between two. The impulses are read back after the solver ran.
class MultibodyRows : public btMultiBodyConstraint {
 public:
  // Required by Bullet's world. The engine solves all in one group and draws nothing.
  int getIslandIdA() const override { return -1; }
  int getIslandIdB() const override { return -1; }
  void debugDraw(btIDebugDraw*) override {}

 protected:
  /// Allocates the rows.
  /// @param link Bullet's link, -1: the base
  MultibodyRows(btMultiBody* body, int link, int rows);
  MultibodyRows(btMultiBody* body, int link, btMultiBody* other, int link_of_other, int rows);
  /// Allocates one Jacobian row of all degrees of freedom per row. Call it when the bodies are
  /// complete.
  void finalizeMultiDof() override;
  /// Adds a row: the velocity by jacobianA(row) of the body plus jacobianB(row) of the other shall
  /// become `velocity` with an impulse in [low, high].
  void add_row(int row, double velocity, double low, double high, btMultiBodyConstraintArray& rows,
               btMultiBodyJacobianData& data, const btContactSolverInfo& info);
  /// Adds a row that keeps `gap` [rad|m] open. The Jacobians of the row give its growth, `rate`
  /// [rad/s|m/s] its present rate. The row acts from the step on in which the gap could close, lets
  /// that step use it up, and recovers from an overrun slowly. Earlier no row is added.
  void add_stop(int row, double gap, double rate, btMultiBodyConstraintArray& rows,
                btMultiBodyJacobianData& data, const btContactSolverInfo& info);
};

}  // namespace navvy::vehicle
