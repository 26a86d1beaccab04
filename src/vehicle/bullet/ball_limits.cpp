// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/ball_limits.h"

#include <cmath>

#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {
namespace {

// [rad] 180 deg in a file, however rounded.
constexpr double kFree = kPi - 1e-6;

}  // namespace

// Splits the rotation into the lean of x and the twist about it.
std::array<std::optional<BallStop>, 3> ball_stops(const Mat3& R, double cone, double twist) {
  std::array<std::optional<BallStop>, 3> out;
  const Vec3 a = Vec3::UnitX(), b = R.col(0), side = a.cross(b);
  const double lean = std::atan2(side.norm(), b.x());
  // An upright ball may lean to any side: no stop until it has begun to.
  if (cone < kFree && side.norm() > 1e-9) out[0] = {cone - lean, -side.normalized()};
  if (twist >= kFree || b.x() < -0.999) return out;
  const Eigen::Quaterniond q(R);
  double turn = 2 * std::atan2(q.x(), q.w());
  if (turn > kPi) turn -= 2 * kPi;
  if (turn < -kPi) turn += 2 * kPi;
  // The twist grows with the rotation about the middle between both axes.
  const Vec3 middle = (a + b) / (1 + b.x());
  out[1] = {turn + twist, middle};
  out[2] = {twist - turn, -middle};
  return out;
}

BallLimits::BallLimits(btMultiBody* body, int link, const Mat3& R_CJ, const Mat3& R_PJ, double cone,
                       double twist)
    : MultibodyRows(body, link, 3), R_CJ_(R_CJ), R_PJ_(R_PJ), cone_(cone), twist_(twist) {
  finalizeMultiDof();
}

// Adds one row for each stop that exists at the present rotation.
void BallLimits::createConstraintRows(btMultiBodyConstraintArray& rows,
                                      btMultiBodyJacobianData& data,
                                      const btContactSolverInfo& info) {
  for (int row = 0; row < 3; ++row) internalSetAppliedImpulse(row, 0);
  const Mat3 R_PC = to_eigen(btMatrix3x3(m_bodyA->getParentToLocalRot(m_linkA).inverse()));
  // Rotation from the joint's frame at the start to the present one. Directions of the former, seen
  // in the child's frame.
  const Mat3 R = R_PJ_.transpose() * R_PC * R_CJ_;
  const Mat3 to_child = R_CJ_ * R.transpose();
  const auto stops = ball_stops(R, cone_, twist_);
  for (int row = 0; row < 3; ++row)
    if (const auto& stop = stops[static_cast<std::size_t>(row)])
      keep_open(row, stop->gap, to_child * stop->axis, rows, data, info);
}

void BallLimits::keep_open(int row, double gap, const Vec3& axis, btMultiBodyConstraintArray& rows,
                           btMultiBodyJacobianData& data, const btContactSolverInfo& info) {
  const btScalar* qd = m_bodyA->getJointVelMultiDof(m_linkA);
  const int offset = 6 + m_bodyA->getLink(m_linkA).m_dofOffset;
  for (int d = 0; d < 3; ++d) jacobianA(row)[offset + d] = axis[d];
  add_stop(row, gap, axis.x() * qd[0] + axis.y() * qd[1] + axis.z() * qd[2], rows, data, info);
}

}  // namespace navvy::vehicle
