// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/joints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vehicle/kinematics.h"

namespace navvy::vehicle {
namespace {

constexpr double kBrakeGain = 10;  // [1/s] back to the position at which the brake was set
// [rad/s|m/s] a braked joint that is faster slips through its brake
constexpr double kSlips = 0.02;

bool moves(const scene::Joint& joint) {
  return joint.type == scene::Joint::Type::kRevolute ||
         joint.type == scene::Joint::Type::kPrismatic;
}

}  // namespace

// Adds one row per joint with a servo, and the stops of ball joints.
MachineJoints::MachineJoints(const scene::Machine& machine, TreeBody& tree)
    : machine_(machine),
      tree_(tree),
      hydraulics_(machine),
      actuators_(machine.joints.size()),
      constraints_(machine.joints.size()),
      drive_rate_(std::numeric_limits<double>::infinity()) {
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const scene::Joint& joint = machine.joints[j];
    // A joint without a command stays where it is, or swings freely.
    actuators_[j].servo.set(
        {joint.passive ? JointMode::kFree : JointMode::kPosition, joint.initial});
    actuators_[j].has_brake = joint.brake > 0 && moves(joint);
    // Fixed and ball joints have no servo, nor has a joint of the base to the world.
    const int k = tree.bullet_of_joint(static_cast<int>(j));
    if (k >= 0 && joint.type == scene::Joint::Type::kBall &&
        (joint.cone < kPi || joint.twist < kPi)) {
      const Mat3 R_CJ =
          tree.inertial_frame(joint.child).linear().transpose() * joint.X_LcJ.linear();
      const Mat3 R_PC = tree.inertial_frame(joint.parent).linear().transpose() *
                        joint_pose(machine, joint, 0).linear() *
                        tree.inertial_frame(joint.child).linear();
      balls_.push_back(std::make_unique<BallLimits>(&tree.multibody(), k, R_CJ, Mat3(R_PC * R_CJ),
                                                    joint.cone, joint.twist));
    }
    if (k >= 0 && moves(joint))
      constraints_[j] = std::make_unique<ServoConstraint>(&tree.multibody(), k, joint.has_limits,
                                                          joint.lower, joint.upper);
  }
  placed();
}

// Positions change only at the end of a step and by a snapshot, so linkages cost nothing else.
void MachineJoints::placed() {
  for (int c = 0; c < hydraulics_.count(); ++c)
    hydraulics_.place(c, tree_.position(hydraulics_.joint(c)));
}

void MachineJoints::set_brake(int joint, bool on) {
  Actuator& a = (*this)[joint];
  if (!a.has_brake || a.braked == on) return;
  a.braked = on;
  a.held = tree_.position(joint);
  // Once released, it holds its position until its valve opens.
  a.servo.rest();
}

JointServo::Demand MachineJoints::hold(int joint, double dt) {
  Actuator& a = (*this)[joint];
  const double q = tree_.position(joint);
  // While it still turns, or is dragged, the held position follows.
  if (std::abs(tree_.velocity(joint)) > kSlips) a.held = q;
  const double most = machine_.joints[static_cast<std::size_t>(joint)].brake;
  return {std::min(kBrakeGain, 0.2 / dt) * (a.held - q), -most, most, 0};
}

void MachineJoints::note_speeds() {
  for (std::size_t j = 0; j < actuators_.size(); ++j)
    actuators_[j].speed_before = tree_.velocity(static_cast<int>(j));
}

JointLimits MachineJoints::limits(int joint) const {
  const scene::Joint& about = machine_.joints[static_cast<std::size_t>(joint)];
  const Actuator& a = (*this)[joint];
  JointLimits limits;
  // The joint's own limits always apply: those of its bearing, or of a motor that is not modelled.
  limits.effort_positive = limits.effort_negative = about.effort;
  limits.speed_positive = limits.speed_negative = about.velocity;
  // A cylinder allows less, and not the same both ways: the rod reduces the area.
  if (const int cylinder = hydraulics_.of_joint(joint); cylinder >= 0) {
    const CylinderLimits& hydraulic = hydraulics_.limits(cylinder);
    limits.effort_positive = std::min(about.effort, hydraulic.torque_positive);
    limits.effort_negative = std::min(about.effort, hydraulic.torque_negative);
    limits.speed_positive = std::min(about.velocity, hydraulic.speed_positive);
    limits.speed_negative = std::min(about.velocity, hydraulic.speed_negative);
  }
  // Steering moves at the drive's rate, not at the joint's.
  if (a.driven && a.servo.input().mode == JointMode::kPosition) {
    limits.speed_positive = std::min(limits.speed_positive, drive_rate_);
    limits.speed_negative = std::min(limits.speed_negative, drive_rate_);
  }
  // The servo needs the inertia at the present pose to brake in time.
  limits.inertia = tree_.outward_inertia(joint);
  return limits;
}

double MachineJoints::share_oil(double dt) {
  // Without a pump every cylinder has its own flow, which limits() includes.
  if (!hydraulics_.has_pump()) return 1;
  demands_.clear();
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    const Actuator& a = actuators_[j];
    const int cylinder = hydraulics_.of_joint(static_cast<int>(j));
    if (cylinder < 0 || !constraints_[j]) continue;
    demands_.push_back(hydraulics_.demand(cylinder, a.opened, a.effort, a.servo.flows()));
  }
  return hydraulics_.pump().share(machine_.pump, demands_, dt);
}

// Two passes, since the share of oil depends on all valves.
void MachineJoints::begin_step(double dt) {
  // Open all valves first to find the pump's demand; then every function gets its share.
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    Actuator& a = actuators_[j];
    if (!constraints_[j] || is_drives(a)) continue;
    const int joint = static_cast<int>(j);
    a.limits = limits(joint);
    // Its valve stays closed.
    a.opened = a.braked ? 0
                        : a.servo.open(machine_.joints[j], a.limits, tree_.position(joint),
                                       tree_.velocity(joint), dt);
  }
  const double share = share_oil(dt);
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    if (!constraints_[j]) continue;
    const int joint = static_cast<int>(j);
    const scene::Joint& about = machine_.joints[j];
    Actuator& a = actuators_[j];
    // The demand is a velocity within limits of effort: one row of the solver, which finds the
    // effort.
    const double qd = tree_.velocity(joint);
    if (!is_drives(a)) {
      // Joints without a cylinder (a swing motor) do not share the pump.
      const double oil = hydraulics_.of_joint(joint) >= 0 ? share : 1.0;
      a.demand = a.braked ? hold(joint, dt)
                          : a.servo.demand(about, a.limits, tree_.position(joint), qd, oil, dt);
      constraints_[j]->command(a.demand.velocity, a.demand.effort_low * dt,
                               a.demand.effort_high * dt);
    }
    // Viscous friction, at most what stops the joint within the step.
    const double damping =
        about.damping > 0 ? std::min(about.damping, 0.5 * tree_.outward_inertia(joint) / dt) : 0;
    tree_.multibody().addJointTorque(tree_.bullet_of_joint(joint),
                                     a.demand.feed_forward - damping * qd);
  }
}

// Reads efforts, and adds up the work and the oil taken.
void MachineJoints::end_step(double dt) {
  placed();
  // The effort is the row's impulse over the step, plus the part applied directly.
  double oil = 0;
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    if (!constraints_[j]) continue;
    Actuator& a = actuators_[j];
    const int joint = static_cast<int>(j);
    const double q = tree_.position(joint), qd = tree_.velocity(joint);
    a.effort = constraints_[j]->motor_impulse() / dt + a.demand.feed_forward;
    // The pump recovers no energy from a load
    work_ += std::max(0.0, a.effort * 0.5 * (a.speed_before + qd) * dt);
    // The servo sees the row alone: a feed-forward never saturates it.
    if (!a.braked)
      a.servo.settle(a.demand, a.limits, constraints_[j]->motor_impulse() / dt, q, qd, dt);
    // Oil displaced by a load flows to the tank.
    const double driven =
        a.servo.input().mode == JointMode::kEffort ? a.demand.feed_forward : a.opened;
    const int cylinder = hydraulics_.of_joint(joint);
    if (hydraulics_.has_pump() && cylinder >= 0 && driven * qd > 0)
      oil += hydraulics_.oil(cylinder, qd);
  }
  // Valves may pass less than they asked for: record the flow after the step.
  hydraulics_.pump().settle(oil);
}

// Combines the tree's motion with the servo's result.
JointState MachineJoints::state(int joint) const {
  const Actuator& a = (*this)[joint];
  const scene::Joint& about = machine_.joints[static_cast<std::size_t>(joint)];
  JointState state;
  state.position = tree_.position(joint);
  state.velocity = tree_.velocity(joint);
  state.effort = a.effort;
  state.effort_limit = about.effort;
  state.velocity_limit = about.velocity;
  if (const int cylinder = hydraulics_.of_joint(joint); cylinder >= 0) {
    const CylinderGeometry& geometry = hydraulics_.geometry(cylinder);
    const CylinderLimits& limits = hydraulics_.limits(cylinder);
    // The limit in the direction of effort and motion.
    const bool up = state.effort >= 0;
    state.effort_limit =
        std::min(about.effort, up ? limits.torque_positive : limits.torque_negative);
    state.velocity_limit = std::min(
        about.velocity, state.velocity >= 0 ? limits.speed_positive : limits.speed_negative);
    state.cylinder_length = geometry.length;
    // The cylinder does not carry what a brake carries.
    state.cylinder_force =
        !a.braked && std::abs(geometry.lever) > 1e-6 ? state.effort / geometry.lever : 0;
  }
  state.stalled = a.servo.stalled();
  state.braked = a.braked;
  return state;
}

void Actuator::visit(Archive& a) {
  a("servo", servo);
  a("driven", driven);
  a("effort", effort);
  if (has_brake) {
    a.unhashed("hashed by the held position while it is set", [&] { a("braked", braked); });
    if (braked) a("held", held);
    a.require(std::isfinite(held), "held", "the position that a brake holds must be finite");
  }
  // The drive turns a wheel without its servo, whose limits then stay those of its last use. Other
  // joints set theirs in every step.
  if (!spins_wheel) return;
  a("limits", limits);
  a("opened", opened);
}

void MachineJoints::visit(Archive& a) {
  a.fixed("joints", actuators_);
  a("pump", hydraulics_.pump());
  a("work", work_);
  if (a.loading()) placed();
}

}  // namespace navvy::vehicle
