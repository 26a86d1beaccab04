// SPDX-License-Identifier: Apache-2.0
#include "scene/close_loops.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "scene/forward_kinematics.h"

namespace navvy::scene {
namespace {

// [m, rad] change of a position for the columns of the Jacobian.
constexpr double kNudge = 1e-6;
// [m] gap that counts as closed: rounding of files with 9 digits is larger.
constexpr double kClosed = 1e-12;
// Damping of Gauss-Newton relative to the largest diagonal term. It only matters at dead centres.
constexpr double kDamping = 1e-9;
// [rad|m] largest change of a position in one iteration.
constexpr double kLongestMove = 0.3;

bool moves(const Joint& joint) {
  return joint.type == Joint::Type::kRevolute || joint.type == Joint::Type::kPrismatic;
}

/// Returns the gaps of all loops, six values each.
Eigen::VectorXd gaps_of(const Machine& machine, const std::vector<double>& q) {
  const std::vector<Pose> X = forward_kinematics(machine, Pose::Identity(), q);
  Eigen::VectorXd out(6 * static_cast<Eigen::Index>(machine.loops.size()));
  Eigen::Index row = 0;
  for (const LoopJoint& loop : machine.loops) {
    out.segment<6>(row) = loop_gap(loop, X[static_cast<std::size_t>(loop.parent)],
                                   X[static_cast<std::size_t>(loop.child)]);
    row += 6;
  }
  return out;
}

/// Returns the joints that may move: neither held nor followers.
std::vector<std::size_t> free_joints(const Machine& machine, const std::vector<char>& held) {
  std::vector<char> led(machine.joints.size(), 0);
  for (const JointGear& gear : machine.gears) led[static_cast<std::size_t>(gear.follower)] = 1;
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < machine.joints.size(); ++j)
    if (held[j] == 0 && led[j] == 0 && moves(machine.joints[j])) out.push_back(j);
  return out;
}

}  // namespace

Vec6 loop_gap(const LoopJoint& loop, const Pose& X_BP, const Pose& X_BC) {
  const Pose X = (X_BP * loop.X_LpJ).inverse() * (X_BC * loop.X_LcJ);
  const Vec3 axis = loop.axis.normalized();
  Vec3 shift = X.translation(), turn = Vec3::Zero();
  if (loop.type == LoopJoint::Type::kPrismatic) shift -= axis.dot(shift) * axis;
  if (loop.type == LoopJoint::Type::kRevolute) {
    turn = axis.cross(X.linear() * axis);
  } else if (loop.type != LoopJoint::Type::kBall) {
    const Eigen::AngleAxisd rotation(Mat3(X.linear()));
    turn = rotation.angle() * rotation.axis();
  }
  Vec6 gap;
  gap << shift, turn;
  return gap;
}

void follow_gears(const Machine& machine, std::vector<double>& q) {
  // Each pass settles at least one more gear of a chain.
  for (std::size_t pass = 0; pass < machine.gears.size(); ++pass)
    for (const JointGear& gear : machine.gears)
      q[static_cast<std::size_t>(gear.follower)] =
          gear.ratio * q[static_cast<std::size_t>(gear.leader)] + gear.offset;
}

double close_loops(const Machine& machine, const std::vector<char>& held, std::vector<double>& q,
                   int most) {
  follow_gears(machine, q);
  if (machine.loops.empty()) return 0;
  const std::vector<std::size_t> free = free_joints(machine, held);
  const auto columns = static_cast<Eigen::Index>(free.size());
  Eigen::VectorXd gap = gaps_of(machine, q);
  for (int i = 0; i < most && columns > 0 && gap.cwiseAbs().maxCoeff() > kClosed; ++i) {
    Eigen::MatrixXd J(gap.size(), columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
      // Central differences: their error is far below the damping.
      std::vector<double> ahead = q, behind = q;
      ahead[free[static_cast<std::size_t>(c)]] += kNudge;
      behind[free[static_cast<std::size_t>(c)]] -= kNudge;
      follow_gears(machine, ahead);
      follow_gears(machine, behind);
      J.col(c) = (gaps_of(machine, ahead) - gaps_of(machine, behind)) / (2 * kNudge);
    }
    Eigen::MatrixXd normal = J.transpose() * J;
    normal.diagonal().array() += kDamping * std::max(normal.diagonal().maxCoeff(), 1e-12);
    Eigen::VectorXd move = -normal.ldlt().solve(J.transpose() * gap);
    const double longest = move.cwiseAbs().maxCoeff();
    if (!(longest > 1e-15)) break;
    move *= std::min(1.0, kLongestMove / longest);
    for (Eigen::Index c = 0; c < columns; ++c) q[free[static_cast<std::size_t>(c)]] += move[c];
    follow_gears(machine, q);
    gap = gaps_of(machine, q);
  }
  return gap.cwiseAbs().maxCoeff();
}

}  // namespace navvy::scene
