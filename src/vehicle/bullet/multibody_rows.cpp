// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/multibody_rows.h"

#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr int kConstraintType = 100;  // beyond Bullet's own types

}  // namespace

MultibodyRows::MultibodyRows(btMultiBody* body, int link, int rows)
    : MultibodyRows(body, link, nullptr, -1, rows) {}

MultibodyRows::MultibodyRows(btMultiBody* body, int link, btMultiBody* other, int link_of_other,
                             int rows)
    : btMultiBodyConstraint(body, other, link, link_of_other, rows, true, kConstraintType) {}

void MultibodyRows::finalizeMultiDof() {
  allocateJacobiansMultiDof();
  m_numDofsFinalized = m_jacSizeBoth;
}

// Fills Bullet's record of a row and lets Bullet compute its effective mass.
void MultibodyRows::add_row(int row, double velocity, double low, double high,
                            btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) {
  btMultiBodySolverConstraint& c = rows.expandNonInitializing();
  // The solver writes the row's impulse back through these.
  c.m_orgConstraint = this;
  c.m_orgDofIndex = row;
  c.m_multiBodyA = m_bodyA;
  // If the other side is the world, the second half would be all zeros.
  c.m_multiBodyB = m_bodyB;
  c.m_solverBodyIdB = m_bodyB == nullptr ? data.m_fixedBodyId : -1;
  c.m_linkA = m_linkA;
  c.m_linkB = m_linkB;
  // Fields of rigid bodies, which this row does not use.
  const btVector3 zero(0, 0, 0);
  c.m_contactNormal1 = c.m_contactNormal2 = zero;
  c.m_relpos1CrossNormal = c.m_relpos2CrossNormal = zero;
  c.m_angularComponentA = c.m_angularComponentB = zero;
  // The Jacobian is given, so normals are zero. There is no error term: `velocity` already includes
  // the gap.
  fillMultiBodyConstraint(c, data, jacobianA(row), m_bodyB == nullptr ? nullptr : jacobianB(row),
                          zero, zero, zero, zero, 0, info, low, high, true, 1, false, velocity);
  c.m_solverBodyIdB = -1;  // no rigid body there
}

// With q the stretch, m the effective mass and h the step, the impulse is -h k (q + c h v'), where
// v' is the velocity after the step, by which the position moves. c = 0 is the semi-implicit Euler
// step, stable for w = h sqrt(k/m) < 2; c >= 1/2 is stable for every w. As a row of the solver:
// v' + impulse / (c h^2 k) = -q / (c h).
void MultibodyRows::add_spring(int row, double stretch, double stiffness, double carried,
                               btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                               const btContactSolverInfo& info) {
  const double h = info.m_timeStep;
  add_row(row, 0, -1e12, 1e12, rows, data, info);
  btMultiBodySolverConstraint& c = rows[rows.size() - 1];
  // Bullet leaves 0 where nothing can move.
  if (!(c.m_jacDiagABInv > 0)) return;
  const double inverse_mass = 1 / c.m_jacDiagABInv, velocity = -c.m_rhs * inverse_mass;
  const double w2 = h * h * stiffness * inverse_mass, part = w2 / (1 + w2);
  const double softness = 1 / (part * h * h * stiffness);
  c.m_jacDiagABInv = 1 / (inverse_mass + softness);
  c.m_cfm = softness * c.m_jacDiagABInv;
  c.m_rhs = (-stretch / (part * h) - carried - velocity) * c.m_jacDiagABInv;
}

void MultibodyRows::add_stop(int row, double gap, double rate, btMultiBodyConstraintArray& rows,
                             btMultiBodyJacobianData& data, const btContactSolverInfo& info) {
  const double dt = info.m_timeStep;
  if (gap >= 2 * dt * std::abs(rate) + 1e-3) return;
  add_row(row, gap > 0 ? -gap / dt : -0.1 * gap / dt, 0, 1e12, rows, data, info);
}

}  // namespace navvy::vehicle
