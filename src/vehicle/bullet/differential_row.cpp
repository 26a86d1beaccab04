// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/differential_row.h"

namespace navvy::vehicle {

DifferentialRow::DifferentialRow(btMultiBody* body,
                                 const std::vector<std::pair<int, double>>& weights)
    : MultibodyRows(body, weights.front().first, 1) {
  finalizeMultiDof();
  for (const auto& [link, weight] : weights)
    jacobianA(0)[6 + m_bodyA->getLink(link).m_dofOffset] = weight;
}

void DifferentialRow::createConstraintRows(btMultiBodyConstraintArray& rows,
                                           btMultiBodyJacobianData& data,
                                           const btContactSolverInfo& info) {
  internalSetAppliedImpulse(0, 0);
  if (limit_ > 0) add_row(0, speed_, -limit_, limit_, rows, data, info);
}

}  // namespace navvy::vehicle
