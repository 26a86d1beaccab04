// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/mechanism_rows.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "scene/close_loops.h"
#include "vehicle/bullet/refuse.h"

namespace navvy::vehicle {
namespace {

constexpr double kClosing = 0.2;  // share of a gap that is closed in a step,
constexpr double kSlowly = 0.5;   // at most [m/s|rad/s]
constexpr double kFirm = 1e12;    // [N s|N m s] impulse of a row without a limit
// Share of the largest motion below which a loop cannot move along a direction: axes that are
// parallel but for the rounding of 3.14 and 1.57 count as parallel.
constexpr double kRigid = 3e-3;
// Share of its inverse mass below which the rows before leave a row no motion.
constexpr double kIdle = 1e-6;

/// Returns the velocity that closes a gap.
double closing(double gap, double dt) {
  return -std::clamp(gap * kClosing / dt, -kSlowly, kSlowly);
}

/// Returns two unit vectors at right angles to a unit vector and to each other.
std::pair<Vec3, Vec3> across(const Vec3& axis) {
  const Vec3 one = axis.unitOrthogonal();
  return {one, axis.cross(one)};
}

/// Returns Bullet's link of a joint.
/// @throws InputError for a joint that has no position of one number.
int link_of(const scene::Machine& machine, const TreeBody& tree, int joint,
            const std::string& element) {
  const auto type = machine.joints.at(static_cast<std::size_t>(joint)).type;
  if (type != scene::Joint::Type::kRevolute && type != scene::Joint::Type::kPrismatic)
    refuse(element, machine.joints[static_cast<std::size_t>(joint)].name,
           "only joints that turn or slide have springs and ratios");
  return tree.bullet_of_joint(joint);
}

}  // namespace

MechanismRows::MechanismRows(const scene::Machine& machine, TreeBody& tree)
    : MultibodyRows(&tree.multibody(), 0,
                    static_cast<int>(machine.gears.size() + 6 * machine.loops.size())),
      machine_(machine),
      tree_(tree) {
  for (const scene::JointGear& gear : machine.gears) {
    const std::string element = "joint[" + gear.name + "]";
    link_of(machine, tree, gear.follower, element);
    link_of(machine, tree, gear.leader, element);
    if (gear.follower == gear.leader || gear.ratio == 0 || !std::isfinite(gear.ratio))
      refuse(element, std::to_string(gear.ratio),
             "a joint follows another one, by a ratio that is not zero");
  }
  finalizeMultiDof();
  for (const scene::LoopJoint& loop : machine.loops) sizes_.push_back(size_of(loop));
}

double MechanismRows::size_of(const scene::LoopJoint& loop) const {
  const Vec3 at = (tree_.link(loop.child).X_WL * loop.X_LcJ).translation();
  double farthest = 1e-3;
  for (const int link : {loop.parent, loop.child})
    for (int k = tree_.bullet_of_link(link); k >= 0; k = m_bodyA->getParent(k))
      farthest = std::max(farthest, (tree_.center(tree_.link_of_bullet(k)) - at).norm());
  return farthest;
}

MechanismRows::Rows MechanismRows::gear_row(const scene::JointGear& gear) const {
  Rows out{Eigen::MatrixXd::Zero(1, 6 + m_bodyA->getNumDofs()), Eigen::VectorXd(1)};
  const int follower = tree_.bullet_of_joint(gear.follower),
            leader = tree_.bullet_of_joint(gear.leader);
  out.jacobian(0, 6 + m_bodyA->getLink(follower).m_dofOffset) = 1;
  out.jacobian(0, 6 + m_bodyA->getLink(leader).m_dofOffset) = -gear.ratio;
  out.gap[0] =
      tree_.position(gear.follower) - gear.ratio * tree_.position(gear.leader) - gear.offset;
  return out;
}

// Each row measures the velocity of the child half minus that of the parent half at one point, so
// the motion of the base drops out.
MechanismRows::Rows MechanismRows::held_by(const scene::LoopJoint& loop, double size) const {
  using Type = scene::LoopJoint::Type;
  const Pose X_WP = tree_.link(loop.parent).X_WL, X_WC = tree_.link(loop.child).X_WL;
  const Mat3 R_WJ = X_WP.linear() * loop.X_LpJ.linear();
  const Vec3 at = (X_WC * loop.X_LcJ).translation();
  const Vec6 gap = scene::loop_gap(loop, X_WP, X_WC);
  const auto [one, other] = across(loop.axis.normalized());
  // Directions that the joint holds, in its own axes.
  const std::vector<Vec3> all = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, two = {one, other},
                          none;
  const std::vector<Vec3>& shifts = loop.type == Type::kPrismatic ? two : all;
  const std::vector<Vec3>& turns = loop.type == Type::kBall       ? none
                                   : loop.type == Type::kRevolute ? two
                                                                  : all;
  const int size_of_row = 6 + m_bodyA->getNumDofs();
  Eigen::VectorXd child(size_of_row), parent(size_of_row);
  const auto count = static_cast<Eigen::Index>(shifts.size() + turns.size());
  Rows out{Eigen::MatrixXd::Zero(count, size_of_row), Eigen::VectorXd(count)};
  Eigen::Index row = 0;
  const auto add = [&](const Vec3& J_W, const Vec3& L_W, double open) {
    tree_.virtual_work(loop.child, J_W, L_W, at, child.data());
    tree_.virtual_work(loop.parent, J_W, L_W, at, parent.data());
    out.jacobian.row(row).tail(size_of_row - 6) =
        (child - parent).tail(size_of_row - 6).transpose();
    out.gap[row++] = open;
  };
  for (const Vec3& shift : shifts) add(R_WJ * shift, Vec3::Zero(), shift.dot(gap.head<3>()));
  for (const Vec3& turn : turns)
    add(Vec3::Zero(), size * (R_WJ * turn), size * turn.dot(gap.tail<3>()));
  return out;
}

// By geometry alone: masses do not decide along which directions a loop can move.
void MechanismRows::reduce(Rows& rows, double size) const {
  // Joints that slide move by a length, others by an angle.
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(rows.jacobian.cols());
  for (int k = 0; k < m_bodyA->getNumLinks(); ++k)
    if (m_bodyA->getLink(k).m_jointType == btMultibodyLink::ePrismatic)
      scale[6 + m_bodyA->getLink(k).m_dofOffset] = size;
  const Eigen::MatrixXd scaled = rows.jacobian * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> motion(scaled * scaled.transpose());
  // Eigenvalues ascend.
  const Eigen::Index count = rows.gap.size();
  const double least = kRigid * kRigid * motion.eigenvalues()[count - 1];
  Eigen::Index first = 0;
  while (first < count && !(motion.eigenvalues()[first] > least)) ++first;
  const Eigen::MatrixXd kept = motion.eigenvectors().rightCols(count - first).transpose();
  rows.jacobian = (kept * rows.jacobian).eval();
  rows.gap = (kept * rows.gap).eval();
}

void MechanismRows::prepare(double dt) {
  std::vector<Rows> parts;
  for (const scene::JointGear& gear : machine_.gears) parts.push_back(gear_row(gear));
  for (std::size_t i = 0; i < machine_.loops.size(); ++i) {
    parts.push_back(held_by(machine_.loops[i], sizes_[i]));
    reduce(parts.back(), sizes_[i]);
  }
  Eigen::Index count = 0;
  for (const Rows& part : parts) count += part.gap.size();
  const Eigen::Index degrees = 6 + m_bodyA->getNumDofs();
  Eigen::MatrixXd jacobian(count, degrees), response(degrees, count);
  Eigen::VectorXd velocity(count);
  Eigen::Index row = 0;
  for (const Rows& part : parts)
    for (Eigen::Index i = 0; i < part.gap.size(); ++i, ++row) {
      Eigen::VectorXd one = part.jacobian.row(i), moved(degrees);
      tree_.respond_to(one.data(), moved.data());
      // In units in which each row has an inverse mass of one, rows can be compared.
      const double unit = 1 / std::sqrt(std::max(one.dot(moved), 1e-300));
      jacobian.row(row) = unit * one.transpose();
      response.col(row) = unit * moved;
      velocity[row] = unit * closing(part.gap[i], dt);
    }
  const Eigen::MatrixXd coupling = jacobian * response;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> apart(0.5 *
                                                             (coupling + coupling.transpose()));
  // Loops may hold the same motion.
  Eigen::Index first = 0;
  while (first < count && !(apart.eigenvalues()[first] > kIdle)) ++first;
  const Eigen::MatrixXd by =
      apart.eigenvectors().rightCols(count - first) *
      apart.eigenvalues().tail(count - first).cwiseSqrt().cwiseInverse().asDiagonal();
  jacobian_ = by.transpose() * jacobian;
  response_ = response * by;
  velocity_ = by.transpose() * velocity;
}

std::optional<double> MechanismRows::project(double* jacobian) const {
  Eigen::Map<Eigen::VectorXd> other(jacobian, 6 + m_bodyA->getNumDofs());
  Eigen::VectorXd moved(other.size());
  tree_.respond_to(jacobian, moved.data());
  const double inverse_mass = other.dot(moved);
  const Eigen::VectorXd shares = response_.transpose() * other;
  other -= jacobian_.transpose() * shares;
  if (!(inverse_mass - shares.squaredNorm() > kIdle * inverse_mass)) return {};
  return shares.dot(velocity_);
}

void MechanismRows::createConstraintRows(btMultiBodyConstraintArray& rows,
                                         btMultiBodyJacobianData& data,
                                         const btContactSolverInfo& info) {
  for (int row = 0; row < getNumRows(); ++row) internalSetAppliedImpulse(row, 0);
  for (Eigen::Index i = 0; i < velocity_.size(); ++i) {
    const int row = static_cast<int>(i);
    Eigen::Map<Eigen::VectorXd>(jacobianA(row), jacobian_.cols()) = jacobian_.row(i).transpose();
    add_row(row, velocity_[i], -kFirm, kFirm, rows, data, info);
  }
}

SpringRow::SpringRow(btMultiBody* body, int link, const scene::Joint& joint,
                     const MechanismRows* mechanism)
    : MultibodyRows(body, link, 1),
      stiffness_(joint.stiffness),
      rest_(joint.rest),
      mechanism_(mechanism) {
  finalizeMultiDof();
}

void SpringRow::createConstraintRows(btMultiBodyConstraintArray& rows,
                                     btMultiBodyJacobianData& data,
                                     const btContactSolverInfo& info) {
  internalSetAppliedImpulse(0, 0);
  std::fill_n(jacobianA(0), 6 + m_bodyA->getNumDofs(), 0.0);
  jacobianA(0)[6 + m_bodyA->getLink(m_linkA).m_dofOffset] = 1;
  const std::optional<double> carried =
      mechanism_ != nullptr ? mechanism_->project(jacobianA(0)) : 0.0;
  if (!carried) return;
  add_spring(0, m_bodyA->getJointPos(m_linkA) - rest_, stiffness_, *carried, rows, data, info);
}

std::unique_ptr<MechanismRows> make_mechanism_rows(const scene::Machine& machine, TreeBody& tree) {
  if (machine.gears.empty() && machine.loops.empty()) return nullptr;
  return std::make_unique<MechanismRows>(machine, tree);
}

std::vector<std::unique_ptr<SpringRow>> make_springs(const scene::Machine& machine, TreeBody& tree,
                                                     const MechanismRows* mechanism) {
  std::vector<std::unique_ptr<SpringRow>> out;
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const scene::Joint& joint = machine.joints[j];
    if (!(joint.stiffness > 0)) continue;
    const int link = link_of(machine, tree, static_cast<int>(j), "joint[" + joint.name + "]");
    if (link >= 0)
      out.push_back(std::make_unique<SpringRow>(&tree.multibody(), link, joint, mechanism));
  }
  return out;
}

}  // namespace navvy::vehicle
