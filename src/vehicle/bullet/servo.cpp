// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/servo.h"

#include <algorithm>

#include "vehicle/bullet/mechanism_rows.h"

namespace navvy::vehicle {
ServoConstraint::ServoConstraint(btMultiBody* body, int link, bool has_limits, double lower,
                                 double upper)
    : MultibodyRows(body, link, 3), has_limits_(has_limits), lower_(lower), upper_(upper) {
  finalizeMultiDof();
}

void ServoConstraint::finalizeMultiDof() {
  MultibodyRows::finalizeMultiDof();
  const int offset = 6 + m_bodyA->getLink(m_linkA).m_dofOffset;
  // Rows: the motor, the lower stop, the upper stop (its impulse pushes back).
  jacobianA(0)[offset] = 1;
  jacobianA(1)[offset] = 1;
  jacobianA(2)[offset] = -1;
}

// The motor's row, then the stops that could be reached in this step.
void ServoConstraint::createConstraintRows(btMultiBodyConstraintArray& rows,
                                           btMultiBodyJacobianData& data,
                                           const btContactSolverInfo& info) {
  // A row that is not added in this step has no impulse to read afterwards.
  for (int row = 0; row < 3; ++row) internalSetAppliedImpulse(row, 0);
  if (low_ < high_ && mechanism_ != nullptr)
    add_coupled(rows, data, info);
  else if (low_ < high_)
    add_row(0, velocity_, low_, high_, rows, data, info);
  if (!has_limits_) return;
  const double q = m_bodyA->getJointPos(m_linkA), qd = m_bodyA->getJointVel(m_linkA);
  add_stop(1, q - lower_, qd, rows, data, info);
  add_stop(2, upper_ - q, -qd, rows, data, info);
}

void ServoConstraint::add_coupled(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                  const btContactSolverInfo& info) {
  std::fill_n(jacobianA(0), 6 + m_bodyA->getNumDofs(), 0.0);
  jacobianA(0)[6 + m_bodyA->getLink(m_linkA).m_dofOffset] = 1;
  // A joint that the mechanism leaves no motion needs no motor.
  if (const auto carried = mechanism_->project(jacobianA(0)))
    add_row(0, velocity_ - *carried, low_, high_, rows, data, info);
}

}  // namespace navvy::vehicle
