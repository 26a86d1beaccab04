// SPDX-License-Identifier: Apache-2.0
// A differential that does not let its two shafts turn as they like, locked or with limited slip,
// and a cage whose speed is given.
#pragma once

#include <utility>
#include <vector>

#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Keeps a weighted sum of joint speeds at a value, zero unless told, with so much torque at most:
/// 1 and -1 hold two wheels together, halves of either sign two axles; what it gives one side it
/// takes from the other. Halves of one sign are a cage between two wheels.
class DifferentialRow final : public MultibodyRows {
 public:
  /// @param weights Bullet's links of the joints and the weight of each [-], at least one.
  DifferentialRow(btMultiBody* body, const std::vector<std::pair<int, double>>& weights);

  /// For the coming step: impulse between the shafts at most [N m s], 0: they turn freely; and the
  /// sum's value [rad/s].
  void limit(double impulse, double speed = 0) { limit_ = impulse, speed_ = speed; }
  /// In the last step [N m s]; a joint gets its weight times this.
  double impulse() { return getAppliedImpulse(0); }

  // Called by Bullet in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  double limit_ = 0, speed_ = 0;
};

}  // namespace navvy::vehicle
