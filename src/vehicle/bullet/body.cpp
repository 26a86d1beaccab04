// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/body.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/limits.h"
#include "vehicle/bullet/convert.h"
#include "vehicle/bullet/refuse.h"
#include "vehicle/kinematics.h"

namespace navvy::vehicle {
namespace {

using JointType = scene::Joint::Type;

/// The expected support of a body is the mean over about this time [s]: the soil's impulses vary
/// over a few steps, and an impact acts once.
constexpr double kBearingTime = 0.02;

/// Returns the frame at the centre of mass along the principal axes. `moments` receives the
/// principal moments.
Pose principal_frame(const scene::Link& link, Vec3& moments) {
  Pose X = Pose::Identity();
  X.translation() = link.p_LCom;
  // Most links are given along their principal axes: no rotation, and no rounding by an
  // eigensolver.
  if (link.inertia.isDiagonal(1e-12)) {
    moments = link.inertia.diagonal();
    return X;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(link.inertia);
  moments = solver.eigenvalues();
  Mat3 R = solver.eigenvectors();
  // Eigenvectors have an arbitrary sign; a frame must be right-handed.
  if (R.determinant() < 0) R.col(0) = -R.col(0);
  X.linear() = R;
  return X;
}

/// Disables Bullet's features for games: sleep, damping, velocity limits.
void leave_to_physics(btMultiBody& body) {
  body.setHasSelfCollision(false);
  body.setCanSleep(false);
  body.setLinearDamping(0);
  body.setAngularDamping(0);
  body.setUseGyroTerm(true);
  body.setMaxCoordinateVelocity(1e9);
  body.setMaxAppliedImpulse(1e12);
}

}  // namespace

TreeBody::TreeBody(const scene::Machine& machine, const Pose& X_WM) {
  if (machine.links.empty()) refuse("machine[" + machine.name + "]", "", "needs at least one link");
  // Bullet's base is link 0 in its own inertial frame; convert the model's placement.
  build(machine);
  const Pose X_WI = X_WM * machine.links[0].X_ML * X_LI_[0];
  body_->setBasePos(to_bt(Vec3(X_WI.translation())));
  body_->setWorldToBaseRot(to_bt(Mat3(X_WI.linear())).inverse());
  for (std::size_t j = 0; j < machine.joints.size(); ++j)
    set_position(static_cast<int>(j), machine.joints[j].initial);
}

// In the order of the joints in the file, as far as their parents are in the tree.
std::vector<int> TreeBody::order_outward(const scene::Machine& machine) {
  // -2: not in the tree yet, -1: Bullet's base
  bullet_of_link_.assign(machine.links.size(), -2);
  bullet_of_joint_.assign(machine.joints.size(), -1);
  bullet_of_link_[0] = -1;
  std::vector<int> order;
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t j = 0; j < machine.joints.size(); ++j) {
      const scene::Joint& joint = machine.joints[j];
      if (joint.parent < 0) continue;
      if (bullet_of_link_[index(joint.parent)] == -2 || bullet_of_link_[index(joint.child)] != -2)
        continue;
      bullet_of_link_[index(joint.child)] = bullet_of_joint_[j] = static_cast<int>(order.size());
      order.push_back(static_cast<int>(j));
      grown = true;
    }
  }
  for (std::size_t i = 0; i < machine.links.size(); ++i)
    if (bullet_of_link_[i] == -2)
      refuse("link[" + machine.links[i].name + "]", "", "no joint connects this link to the base");
  return order;
}

void TreeBody::build(const scene::Machine& machine) {
  const std::size_t links = machine.links.size();
  X_LI_.resize(links);
  mass_.resize(links);
  inertia_.resize(links);
  // A fixed joint of the base to the world means the same as the flag.
  bool fixed = machine.fixed_base;
  for (const scene::Joint& joint : machine.joints)
    fixed = fixed || (joint.parent < 0 && joint.type == JointType::kFixed && joint.child == 0);
  std::vector<Vec3> moments(links);
  for (std::size_t i = 0; i < links; ++i) {
    const scene::Link& link = machine.links[i];
    X_LI_[i] = principal_frame(link, moments[i]);
    mass_[i] = link.mass;
    inertia_[i] = link.inertia;
    if (!(link.mass > 0) || !(moments[i].minCoeff() > 0))
      refuse("link[" + link.name + "]", std::to_string(link.mass),
             "a moving link needs positive mass and inertia");
  }
  const std::vector<int> order = order_outward(machine);
  body_ = std::make_unique<btMultiBody>(static_cast<int>(order.size()), mass_[0], to_bt(moments[0]),
                                        fixed, false);
  link_of_bullet_.assign(order.size(), 0);
  joint_of_bullet_ = order;
  pivot_I_.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    link_of_bullet_[k] = machine.joints[index(order[k])].child;
    add_joint(machine, order[k], static_cast<int>(k));
  }
  // Bullet's arrays of positions and velocities now have their size.
  body_->finalizeMultiDof();
  leave_to_physics(*body_);
  // For inertias about a joint: the links beyond it. Parents come before children, so one walk
  // inward per link is enough.
  outward_.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    for (int up = static_cast<int>(k); up >= 0; up = body_->getParent(up))
      outward_[index(up)].push_back(link_of_bullet_[k]);
  frames_.resize(links);
  for (std::size_t i = 0; i < links; ++i)
    // A fixed base is part of the world: it has no momentum, and no drive moves it.
    if (!fixed || i > 0) total_mass_ += mass_[i];
}

void TreeBody::add_joint(const scene::Machine& machine, int j, int k) {
  const scene::Joint& joint = machine.joints[index(j)];
  const std::size_t child = index(joint.child), parent = index(joint.parent);
  const Pose X_PI = X_LI_[parent].inverse();
  // Bullet's data is from inertial frame to inertial frame, at joint position 0.
  // Child's frame in the parent's
  const Pose X_IpIc = X_PI * joint_pose(machine, joint, 0) * X_LI_[child];
  const Vec3 pivot_c = X_LI_[child].inverse() * Vec3(joint.X_LcJ.translation());
  const Vec3 axis_c =
      X_LI_[child].linear().transpose() * (joint.X_LcJ.linear() * joint.axis.normalized());
  pivot_I_[index(k)] = pivot_c;
  const Vec3 pivot_p = X_IpIc * pivot_c;
  // Bullet rotates from parent to child; a pose here places the child in its parent. Invert.
  const btQuaternion turn = to_bt(Mat3(X_IpIc.linear())).inverse();
  const int up = bullet_of_link_[parent];
  Vec3 moments;
  principal_frame(machine.links[child], moments);
  // e: parent's centre to pivot, in the parent; d: pivot to the child's centre, in the child.
  const btVector3 inertia = to_bt(moments), e = to_bt(pivot_p), d = to_bt(Vec3(-pivot_c));
  const double mass = mass_[child];
  switch (joint.type) {
    case JointType::kFixed:
      body_->setupFixed(k, mass, inertia, up, turn, e, d);
      break;
    case JointType::kRevolute:
      body_->setupRevolute(k, mass, inertia, up, turn, to_bt(axis_c), e, d, true);
      break;
    case JointType::kPrismatic:
      body_->setupPrismatic(k, mass, inertia, up, turn, to_bt(axis_c), e, d, true);
      break;
    case JointType::kBall:
      body_->setupSpherical(k, mass, inertia, up, turn, e, d, true);
      break;
  }
}

// Fixed and ball joints have no single position and return 0.
double TreeBody::position(int joint) const {
  const int k = bullet_of_joint_[index(joint)];
  return k >= 0 && body_->getLink(k).m_dofCount == 1 ? body_->getJointPos(k) : 0;
}

double TreeBody::velocity(int joint) const {
  const int k = bullet_of_joint_[index(joint)];
  return k >= 0 && body_->getLink(k).m_dofCount == 1 ? body_->getJointVel(k) : 0;
}

LinkState TreeBody::moved_link(int i) const {
  LinkState out = link(i);
  if (added_.empty()) return out;
  const Vec6 twist = twist_of(i, added_);
  out.w_WL -= twist.head<3>();
  out.v_WL -= twist.tail<3>();
  return out;
}

double TreeBody::moved_velocity(int joint) const {
  const int k = bullet_of_joint_[index(joint)];
  if (added_.empty() || k < 0 || body_->getLink(k).m_dofCount != 1) return velocity(joint);
  return velocity(joint) - added_[index(6 + body_->getLink(k).m_dofOffset)];
}

void TreeBody::set_position(int joint, double q) {
  const int k = bullet_of_joint_[index(joint)];
  if (k < 0 || body_->getLink(k).m_dofCount != 1) return;
  body_->setJointPos(k, q);
  moved();
}

// Frames are those at the centres of mass; `link` converts them.
void TreeBody::update_kinematics() const {
  // Outward from the base, each link from its parent: Bullet stores joint coordinates, not poses in
  // W.
  if (kinematics_valid_) return;
  Frame& base = frames_[0];
  base.X_WI.linear() = to_eigen(btMatrix3x3(body_->getWorldToBaseRot().inverse()));
  base.X_WI.translation() = to_eigen(body_->getBasePos());
  base.v_W = to_eigen(body_->getBaseVel());
  base.w_W = to_eigen(body_->getBaseOmega());
  for (int k = 0; k < body_->getNumLinks(); ++k) {
    const int up = body_->getParent(k);
    const Frame& p = frames_[up < 0 ? 0 : index(link_of_bullet_[index(up)])];
    Frame& c = frames_[index(link_of_bullet_[index(k)])];
    // Rotation of the child in the parent, and the vector from the parent's centre to the child's,
    // in the child.
    const Mat3 R_pc = to_eigen(btMatrix3x3(body_->getParentToLocalRot(k).inverse()));
    const Mat3 R = p.X_WI.linear() * R_pc;
    const Vec3 r = R * to_eigen(body_->getRVector(k));
    c.X_WI.linear() = R;
    c.X_WI.translation() = p.X_WI.translation() + r;
    c.w_W = p.w_W;
    c.v_W = p.v_W + p.w_W.cross(r);
    // Each degree of freedom adds its spatial axis: top is angular, bottom is the velocity of the
    // child's centre.
    const btMultibodyLink& link = body_->getLink(k);
    for (int d = 0; d < link.m_dofCount; ++d) {
      const double qd = body_->getJointVelMultiDof(k)[d];
      c.w_W += qd * (R * to_eigen(link.getAxisTop(d)));
      c.v_W += qd * (R * to_eigen(link.getAxisBottom(d)));
    }
  }
  kinematics_valid_ = true;
}

void TreeBody::update_factors() const {
  if (factors_valid_) return;
  // A step of zero length updates the articulated inertias and moves nothing.
  body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scratch_r_, scratch_v_, scratch_m_,
                                                              false, false, false);
  factors_valid_ = true;
}

// Moves the velocity from the centre of mass to the link's origin.
LinkState TreeBody::link(int link) const {
  update_kinematics();
  const Frame& frame = frames_[index(link)];
  LinkState state;
  // Convert from the inertial frame to the model's frame, with the velocity of a rigid body.
  state.X_WL = frame.X_WI * X_LI_[index(link)].inverse();
  state.w_WL = frame.w_W;
  state.v_WL = frame.v_W + frame.w_W.cross(state.X_WL.translation() - frame.X_WI.translation());
  return state;
}

Vec3 TreeBody::center(int link) const {
  update_kinematics();
  return frames_[index(link)].X_WI.translation();
}

Vec3 TreeBody::momentum() const {
  update_kinematics();
  // Linear momentum only: spinning wheels and the swing have none.
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < frames_.size(); ++i)
    if (i > 0 || !body_->hasFixedBase()) sum += mass_[i] * frames_[i].v_W;
  return sum;
}

Vec3 TreeBody::joint_origin(int joint) const {
  update_kinematics();
  const int k = bullet_of_joint_[index(joint)];
  return frames_[index(link_of_bullet_[index(k)])].X_WI * pivot_I_[index(k)];
}

// Bullet stores a revolute axis in the angular part of the spatial axis, a prismatic one in the
// linear part.
Vec3 TreeBody::joint_axis(int joint) const {
  update_kinematics();
  const int k = bullet_of_joint_[index(joint)];
  const btMultibodyLink& link = body_->getLink(k);
  const bool turns = link.m_jointType == btMultibodyLink::eRevolute;
  const btVector3& axis = turns ? link.getAxisTop(0) : link.getAxisBottom(0);
  return frames_[index(link_of_bullet_[index(k)])].X_WI.linear() * to_eigen(axis);
}

// Sums over all links that move with the joint.
double TreeBody::outward_inertia(int joint) const {
  const int k = bullet_of_joint_[index(joint)];
  if (k < 0) return 0;
  const bool turns = body_->getLink(k).m_jointType == btMultibodyLink::eRevolute;
  const Vec3 axis = joint_axis(joint), origin = joint_origin(joint);
  double sum = 0;
  for (const int link : outward_[index(k)]) {
    if (!turns) {
      sum += mass_[index(link)];
      continue;
    }
    const Frame& frame = frames_[index(link)];
    // Parallel axis theorem: own inertia about the axis, and mass times the centre's distance
    // squared.
    const Mat3 R = frame.X_WI.linear() * X_LI_[index(link)].linear().transpose();
    const Vec3 axis_L = R.transpose() * axis;
    sum += axis_L.dot(inertia_[index(link)] * axis_L) +
           mass_[index(link)] * axis.cross(frame.X_WI.translation() - origin).squaredNorm();
  }
  return sum;
}

void TreeBody::add_force(int link, const Vec3& f_W, const Vec3& m_W, const Vec3& p_W) {
  // Bullet applies forces at centres of mass; the lever arm adds a moment.
  const Vec3 moment = m_W + (p_W - center(link)).cross(f_W);
  const int k = bullet_of_link_[index(link)];
  if (k < 0) {
    body_->addBaseForce(to_bt(f_W));
    body_->addBaseTorque(to_bt(moment));
  } else {
    body_->addLinkForce(k, to_bt(f_W));
    body_->addLinkTorque(k, to_bt(moment));
  }
}

// Walks from the link to the base.
void TreeBody::virtual_work(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
                            double* work) const {
  update_kinematics();
  // Only degrees of freedom between the base and this link move its points; the others do no work.
  std::fill_n(work, 6 + body_->getNumDofs(), 0.0);
  // The base rotates about its own centre.
  const Vec3 base = L_W + (p_W - frames_[0].X_WI.translation()).cross(J_W);
  for (int a = 0; a < 3; ++a) {
    work[a] = base[a];
    work[3 + a] = J_W[a];
  }
  for (int k = bullet_of_link_[index(link)]; k >= 0; k = body_->getParent(k)) {
    const Frame& frame = frames_[index(link_of_bullet_[index(k)])];
    const Vec3 moment = L_W + (p_W - frame.X_WI.translation()).cross(J_W);
    const btMultibodyLink& part = body_->getLink(k);
    for (int d = 0; d < part.m_dofCount; ++d)
      work[6 + part.m_dofOffset + d] =
          (frame.X_WI.linear() * to_eigen(part.getAxisTop(d))).dot(moment) +
          (frame.X_WI.linear() * to_eigen(part.getAxisBottom(d))).dot(J_W);
  }
}

// Uses Bullet's factors of the articulated inertia.
void TreeBody::respond(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
                       std::vector<double>& delta) const {
  // Articulated response: the impulse's work on every degree of freedom, divided by the tree's mass
  // matrix without forming it.
  update_factors();
  const std::size_t size = 6 + index(body_->getNumDofs());
  std::vector<double> work(size);
  virtual_work(link, J_W, L_W, p_W, work.data());
  delta.assign(size, 0.0);
  body_->calcAccelerationDeltasMultiDof(work.data(), delta.data(), scratch_r_, scratch_v_);
}

// Records the impulse as expected support of a body without joints.
bool TreeBody::apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
                             double dt) {
  std::vector<double> delta;
  respond(link, J_W, L_W, p_W, delta);
  body_->applyDeltaVeeMultiDof(delta.data(), 1);
  // Rows that act before the next step's positions hold the joints. The soil's effect on them must
  // meet those rows first, or a cylinder would yield under its load in every step. A single body
  // has no rows.
  const bool moves = dt > 0 && body_->getNumLinks() == 0;
  if (moves) {
    support_.head<3>() += L_W + (p_W - center(0)).cross(J_W);
    support_.tail<3>() += J_W;
    body_->stepPositionsMultiDof(dt, nullptr, delta.data());
    moved();
  } else if (dt > 0) {
    added_.resize(delta.size(), 0.0);
    for (std::size_t i = 0; i < delta.size(); ++i) added_[i] += delta[i];
  }
  // Only velocities changed; the articulated inertia depends on the pose.
  kinematics_valid_ = false;
  return moves;
}

Vec6 TreeBody::twist_of(int link, const std::vector<double>& velocity) const {
  const Frame& frame = frames_[index(link)];
  // Sum the contribution of each degree of freedom between base and link to its origin, at the
  // present pose.
  const Vec3 origin = (frame.X_WI * X_LI_[index(link)].inverse()).translation();
  const Vec3 w0(velocity[0], velocity[1], velocity[2]), v0(velocity[3], velocity[4], velocity[5]);
  Vec3 w = w0, v = v0 + w0.cross(origin - frames_[0].X_WI.translation());
  for (int k = bullet_of_link_[index(link)]; k >= 0; k = body_->getParent(k)) {
    const Frame& at = frames_[index(link_of_bullet_[index(k)])];
    const btMultibodyLink& part = body_->getLink(k);
    for (int d = 0; d < part.m_dofCount; ++d) {
      const double rate = velocity[index(6 + part.m_dofOffset + d)];
      const Vec3 top = rate * (at.X_WI.linear() * to_eigen(part.getAxisTop(d)));
      w += top;
      v += rate * (at.X_WI.linear() * to_eigen(part.getAxisBottom(d))) +
           top.cross(origin - at.X_WI.translation());
    }
  }
  Vec6 twist;
  twist << w, v;
  return twist;
}

// Applies six unit impulses.
Mat6 TreeBody::inverse_mass(int link) const {
  update_kinematics();
  // Column c is the twist by a unit impulse: about x, y, z, then along them, at the link's origin.
  const Vec3 origin = this->link(link).X_WL.translation();
  Mat6 result;
  std::vector<double> delta;
  for (int c = 0; c < 6; ++c) {
    const Vec3 unit = Vec3::Unit(c % 3);
    respond(link, c < 3 ? Vec3::Zero() : unit, c < 3 ? unit : Vec3::Zero(), origin, delta);
    result.col(c) = twist_of(link, delta);
  }
  return 0.5 * (result + result.transpose());  // symmetric up to rounding
}

// Adds gravity to every link, then the expected support.
void TreeBody::step_velocities(const Vec3& gravity, double dt) {
  added_.clear();
  // Gravity is a force here, so that all forces take one articulated step.
  body_->addBaseForce(to_bt(Vec3(gravity * body_->getBaseMass())));
  for (int k = 0; k < body_->getNumLinks(); ++k)
    body_->addLinkForce(k, to_bt(Vec3(gravity * body_->getLinkMass(k))));
  body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(dt, scratch_r_, scratch_v_,
                                                              scratch_m_, false, false, false);
  kinematics_valid_ = false;
  // The solver must see a supported body; otherwise everything that rests on it would fall with it
  // until the soil acts.
  const Vec6 supported = support_;
  support_.setZero();
  if (supported.isZero(0)) {
    bearing_.setZero();
    return;
  }
  bearing_ += std::min(1.0, dt / kBearingTime) * (supported / dt - bearing_);
  respond(0, dt * bearing_.tail<3>(), dt * bearing_.head<3>(), center(0), expected_);
  body_->applyDeltaVeeMultiDof(expected_.data(), 1);
  kinematics_valid_ = false;
}

// Removes the expected support before the positions move.
void TreeBody::step_positions(double dt) {
  // Add the solver's changes to the velocities, which then move the positions: semi-implicit Euler.
  body_->processDeltaVeeMultiDof2();
  // The soil adds its support itself: remove the expected one.
  if (!expected_.empty()) body_->applyDeltaVeeMultiDof(expected_.data(), -1);
  expected_.clear();
  body_->stepPositionsMultiDof(dt);
  body_->clearConstraintForces();
  body_->clearForcesAndTorques();
  moved();
}

// Collision objects do not follow by themselves; contacts are detected at these poses.
void TreeBody::place_colliders() {
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> places;
  body_->updateCollisionObjectWorldTransforms(turns, places);
}

void TreeBody::set_base(const LinkState& link) {
  const Pose X_WI = link.X_WL * X_LI_[0];
  const Vec3 v_W = link.v_WL + link.w_WL.cross(X_WI.translation() - link.X_WL.translation());
  body_->setBasePos(to_bt(Vec3(X_WI.translation())));
  body_->setWorldToBaseRot(to_bt(Mat3(X_WI.linear())).inverse());
  body_->setBaseVel(to_bt(v_W));
  body_->setBaseOmega(to_bt(link.w_WL));
  added_.clear();
  moved();
}

void TreeBody::stop() {
  place(coordinates(), std::vector<double>(6 + index(body_->getNumDofs()), 0.0));
  added_.clear();
  kinematics_valid_ = false;
}

// The base as position and quaternion.
std::vector<double> TreeBody::coordinates() const {
  const btVector3 p = body_->getBasePos();
  const btQuaternion q = body_->getWorldToBaseRot();
  std::vector<double> all = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  for (int k = 0; k < body_->getNumLinks(); ++k)
    all.insert(all.end(), body_->getJointPosMultiDof(k),
               body_->getJointPosMultiDof(k) + body_->getLink(k).m_posVarCount);
  return all;
}

std::vector<double> TreeBody::velocities() const {
  const btScalar* first = body_->getVelocityVector();
  return {first, first + 6 + body_->getNumDofs()};
}

void TreeBody::place(const std::vector<double>& coordinates,
                     const std::vector<double>& velocities) {
  const double* q = coordinates.data();
  body_->setBasePos(btVector3(q[0], q[1], q[2]));
  body_->setWorldToBaseRot(btQuaternion(q[3], q[4], q[5], q[6]));
  // Angular before linear, both in W.
  const double* qd = velocities.data();
  body_->setBaseOmega(btVector3(qd[0], qd[1], qd[2]));
  body_->setBaseVel(btVector3(qd[3], qd[4], qd[5]));
  q += 7;
  qd += 6;
  for (int k = 0; k < body_->getNumLinks(); ++k) {
    // Arrays of Bullet's own sizes: the number of values it copies depends on its version and the
    // kind of joint.
    btScalar position[7] = {}, rate[6] = {};
    for (int i = 0; i < body_->getLink(k).m_posVarCount; ++i) position[i] = *q++;
    for (int d = 0; d < body_->getLink(k).m_dofCount; ++d) rate[d] = *qd++;
    body_->setJointPosMultiDof(k, position);
    body_->setJointVelMultiDof(k, rate);
  }
}

// Checks what a damaged snapshot could break.
void TreeBody::visit(Archive& a) {
  // Coordinates and generalised velocities are complete; poses in W follow from them.
  std::vector<double> q = coordinates(), qd = velocities();
  a.fixed("coordinates", q);
  a.fixed("velocities", qd);
  a("added", added_);
  a("support", support_);
  a("bearing", bearing_);
  a.require(support_.allFinite() && bearing_.allFinite(), "bearing",
            "the support of a body must be finite");
  if (!a.loading()) return;
  const auto finite = [](double v) { return std::isfinite(v); };
  const bool near =
      std::all_of(q.begin(), q.end(), finite) && Vec3(q[0], q[1], q[2]).norm() < limits::kFarthest;
  a.require(near, "coordinates", "the pose of a machine must be finite and near the site");
  a.require(std::abs(Eigen::Vector4d(q[3], q[4], q[5], q[6]).norm() - 1) < 1e-6, "coordinates",
            "a machine's rotation must be a unit quaternion");
  a.require(std::all_of(qd.begin(), qd.end(), finite), "velocities", "velocities must be finite");
  a.require((added_.empty() || added_.size() == qd.size()) &&
                std::all_of(added_.begin(), added_.end(), finite),
            "added", "must be as many finite velocities as the machine has, or none");
  place(q, qd);
  // A snapshot is between two steps: no force of the last one remains.
  expected_.clear();
  body_->clearForcesAndTorques();
  body_->clearConstraintForces();
  moved();
  place_colliders();
}

}  // namespace navvy::vehicle
