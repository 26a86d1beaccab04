// SPDX-License-Identifier: Apache-2.0
// Constraint row for a differential that is locked or has limited slip, and for a differential
// carrier with a prescribed speed.
#pragma once

#include <utility>
#include <vector>

#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Constraint row that keeps a weighted sum of joint speeds at a given value (zero by default) with
/// a limited torque.
///
/// The weights 1 and -1 lock two wheels together, and weights of +-1/2 lock two axles of two wheels
/// each; the torque taken from one side is given to the other. With the weights 1/2 and 1/2, the
/// sum is the speed of the carrier between two wheels.
class DifferentialRow final : public MultibodyRows {
 public:
  /// Allocates the row for a body.
  /// @param weights Bullet's link index of each joint and the joint's weight [-]; at least one
  /// entry
  DifferentialRow(btMultiBody* body, const std::vector<std::pair<int, double>>& weights);

  /// Sets, for the coming step, the largest impulse between the shafts [N m s], where 0 lets them
  /// turn freely, and the value `speed` of the sum [rad/s].
  void limit(double impulse, double speed = 0) { limit_ = impulse, speed_ = speed; }
  /// Returns the impulse of the row in the last step [N m s]. Each joint receives its weight times
  /// this impulse.
  double impulse() { return getAppliedImpulse(0); }

  /// Adds the row to the solver. Bullet calls it in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Largest impulse [N m s], and value of the sum [rad/s], for the coming step.
  double limit_ = 0, speed_ = 0;
};

}  // namespace navvy::vehicle
