// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/servo.h"

namespace navvy::vehicle {
ServoConstraint::ServoConstraint(btMultiBody* body, int link, bool has_limits, double lower, double upper)
    : WorldConstraint(body, link, 3), has_limits_(has_limits), lower_(lower), upper_(upper) {
  finalizeMultiDof();
}

void ServoConstraint::finalizeMultiDof() {
  WorldConstraint::finalizeMultiDof();
  const int offset = 6 + m_bodyA->getLink(m_linkA).m_dofOffset;
  // Rows: the motor, the lower limit, the upper limit (its impulse pushes back).
  jacobianA(0)[offset] = 1;
  jacobianA(1)[offset] = 1;
  jacobianA(2)[offset] = -1;
}

void ServoConstraint::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                           const btContactSolverInfo& info) {
  // A row that is not made in this step has no impulse to read afterwards.
  for (int row = 0; row < 3; ++row) internalSetAppliedImpulse(row, 0);
  if (low_ < high_) add_row(0, velocity_, low_, high_, rows, data, info);
  if (!has_limits_) return;
  // A limit acts from the step in which the joint could reach it: it may use up the gap, and leaves an overrun slowly.
  const double dt = info.m_timeStep, q = m_bodyA->getJointPos(m_linkA);
  const double qd = m_bodyA->getJointVel(m_linkA);
  const double gap_low = q - lower_, gap_high = upper_ - q;
  const double near = 2 * dt * (qd < 0 ? -qd : qd) + 1e-3;
  const auto allowed = [dt](double gap) { return gap > 0 ? -gap / dt : -0.1 * gap / dt; };
  if (gap_low < near) add_row(1, allowed(gap_low), 0, 1e12, rows, data, info);
  if (gap_high < near) add_row(2, allowed(gap_high), 0, 1e12, rows, data, info);
}

}  // namespace navvy::vehicle
