// SPDX-License-Identifier: Apache-2.0
// Common base of all constraint rows between a multibody and the world, or between two multibodies.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace navvy::vehicle {

/// Bullet constraint that adds rows on the velocities of one multibody, or on those of two. After
/// the solver has run, each row's impulse can be read back.
class MultibodyRows : public btMultiBodyConstraint {
 public:
  /// Returns -1, since the engine solves all bodies in one group. Required by Bullet.
  int getIslandIdA() const override { return -1; }
  /// Returns -1, since the engine solves all bodies in one group. Required by Bullet.
  int getIslandIdB() const override { return -1; }
  /// Does nothing. Required by Bullet.
  void debugDraw(btIDebugDraw*) override {}

 protected:
  /// Allocates `rows` rows between a body and the world.
  /// @param link Bullet's link index, -1 for the base
  MultibodyRows(btMultiBody* body, int link, int rows);
  /// Allocates `rows` rows between a link of `body` and a link of `other`.
  /// @param link, link_of_other Bullet's link indices, -1 for a base
  MultibodyRows(btMultiBody* body, int link, btMultiBody* other, int link_of_other, int rows);
  /// Allocates the Jacobian of each row, with one entry per degree of freedom of the bodies. Call
  /// it when the bodies are complete.
  void finalizeMultiDof() override;
  /// Adds the row with index `row` to the solver. The solver brings the velocity that the row
  /// measures to `velocity` with an impulse between `low` and `high`. That velocity is
  /// jacobianA(row) times the velocity of the body plus, with two bodies, jacobianB(row) times that
  /// of the other.
  void add_row(int row, double velocity, double low, double high, btMultiBodyConstraintArray& rows,
               btMultiBodyJacobianData& data, const btContactSolverInfo& info);
  /// Adds the row with index `row` as a spring of the stiffness `stiffness` [N m/rad|N/m] that is
  /// stretched by `stretch` [rad|m]. The row measures the rate of the stretch without a part of it,
  /// `carried` [rad/s|m/s], that other rows cause. The solver finds the spring's impulse together
  /// with all others.
  ///
  /// A soft spring acts as in the semi-implicit Euler step, without numerical damping. A spring
  /// whose period is short against the step is damped so much that it stays stable.
  void add_spring(int row, double stretch, double stiffness, double carried,
                  btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                  const btContactSolverInfo& info);
  /// Adds a row that prevents the distance `gap` [rad|m] to a stop from becoming negative, with
  /// unlimited impulse.
  ///
  /// The Jacobians of the row must measure the rate of change of the gap; `rate` is its current
  /// value [rad/s|m/s]. The row is added only if the gap could close in this step. It allows the
  /// gap to close completely within the step, and lets an overrun (a negative gap) recover slowly.
  void add_stop(int row, double gap, double rate, btMultiBodyConstraintArray& rows,
                btMultiBodyJacobianData& data, const btContactSolverInfo& info);
};

}  // namespace navvy::vehicle
