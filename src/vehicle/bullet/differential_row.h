// SPDX-License-Identifier: Apache-2.0
// Constraint row of a differential with locked or limited slip, and of a carrier with a prescribed
// speed.
#pragma once

#include <utility>
#include <vector>

#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Keeps a weighted sum of joint speeds at a value (zero by default) with a limited torque. Weights
/// 1 and -1 lock two wheels together, halves of either sign lock two axles; the torque taken from
/// one side is given to the other. Halves of one sign are the carrier between two wheels.
class DifferentialRow final : public MultibodyRows {
 public:
  /// Adds the row to a body.
  /// @param weights Bullet's links of the joints and the weight of each [-], at least one.
  DifferentialRow(btMultiBody* body, const std::vector<std::pair<int, double>>& weights);

  /// Sets the limit for the coming step: impulse between the shafts [N m s], 0: they turn freely;
  /// and the value of the sum [rad/s].
  void limit(double impulse, double speed = 0) { limit_ = impulse, speed_ = speed; }
  /// Returns the impulse of the last step [N m s]; a joint gets its weight times this.
  double impulse() { return getAppliedImpulse(0); }

  // Bullet calls this in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  double limit_ = 0, speed_ = 0;
};

}  // namespace navvy::vehicle
