// SPDX-License-Identifier: Apache-2.0
// A differential that does not let its two shafts turn as they like: locked, or with limited slip.
#pragma once

#include <utility>
#include <vector>

#include "vehicle/bullet/world_constraint.h"

namespace navvy::vehicle {

/// Keeps a weighted sum of joint speeds at zero with so much torque at most: 1 and -1 hold two wheels together, halves
/// of either sign two axles. What it gives one side it takes from the other.
class DifferentialRow final : public WorldConstraint {
 public:
  /// @param weights Bullet's links of the joints and the weight of each [-], at least one.
  DifferentialRow(btMultiBody* body, const std::vector<std::pair<int, double>>& weights);

  /// For the coming step: impulse between the shafts at most [N m s]; 0: they turn freely.
  void limit(double impulse) { limit_ = impulse; }

  // Called by Bullet in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  double limit_ = 0;
};

}  // namespace navvy::vehicle
