// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/machine.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {
namespace {

using JointType = scene::Joint::Type;

constexpr double kContactStiffness = 2e7;  // [N/m] tuned: BulletEngine.RaisedGroundDoesNotLaunchABody
constexpr double kContactDamping = 1e7;    // [N s/m] with it: overlap is pressed out at 2 per second
constexpr double kBrakeGain = 10;          // [1/s] back to the angle at which the wheel was stopped

bool moves(const scene::Joint& joint) {
  return joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
}

[[noreturn]] void refuse(const std::string& element, const std::string& value, const std::string& rule) {
  Fault fault;
  fault.element = element;
  fault.value = value;
  fault.rule = rule;
  throw InputError(fault);
}

}  // namespace

BulletMachine::BulletMachine(const scene::Machine& machine, const Pose& X_WM)
    : machine_(machine), tree_(machine_, X_WM) {
  add_actuators();
  add_tyres();
  add_colliders();
  add_rock();
  drive_input_.brake = true;
}

void BulletMachine::add_actuators() {
  actuators_.resize(machine_.joints.size());
  constraints_.resize(machine_.joints.size());
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    const scene::Joint& joint = machine_.joints[j];
    // Whatever nobody commands stays where it is.
    actuators_[j].servo.set({JointMode::kPosition, joint.initial});
    const int k = tree_.bullet_of_joint(static_cast<int>(j));
    if (k >= 0 && moves(joint))
      constraints_[j] =
          std::make_unique<ServoConstraint>(&tree_.multibody(), k, joint.has_limits, joint.lower, joint.upper);
  }
  for (const scene::Cylinder& cylinder : machine_.cylinders) {
    cylinders_.emplace_back(machine_, cylinder);
    Actuator& actuator = actuators_[index(cylinders_.back().joint())];
    if (actuator.cylinder >= 0)
      refuse("cylinder[" + cylinder.name + "]", cylinder.joint, "one cylinder a joint: use count");
    actuator.cylinder = static_cast<int>(cylinders_.size()) - 1;
  }
}

void BulletMachine::add_tyres() {
  for (const scene::Wheel& wheel : machine_.wheels) {
    Tyre tyre;
    tyre.spin_joint = machine_.joint_index(wheel.joint);
    if (tyre.spin_joint < 0) refuse("wheel", wheel.joint, "no joint of this name");
    const scene::Joint& joint = machine_.joints[index(tyre.spin_joint)];
    if (joint.type != JointType::kRevolute || joint.parent < 0)
      refuse("wheel", wheel.joint, "a wheel spins on a revolute joint of the machine");
    tyre.wheel_link = joint.child;
    tyre.carrier_link = joint.parent;
    const scene::Link& link = machine_.links[index(joint.child)];
    const Vec3 axis_L = joint.X_LcJ.linear() * joint.axis.normalized();
    tyre.spin_inertia = axis_L.dot(link.inertia * axis_L);
    const Pose X_CL = joint_pose(machine_, joint, 0);
    tyre.axis_C = X_CL.linear() * axis_L;
    tyre.center_C = X_CL * Vec3(joint.X_LcJ.translation());
    actuators_[index(tyre.spin_joint)].driven = machine_.has_drive;
    // Without a drive wheels turn freely, as on a trailer.
    if (!machine_.has_drive) actuators_[index(tyre.spin_joint)].servo.set({JointMode::kFree, 0});
    if (!wheel.steer_joint.empty()) {
      tyre.steer_joint = machine_.joint_index(wheel.steer_joint);
      if (tyre.steer_joint < 0) refuse("wheel", wheel.steer_joint, "no joint of this name");
      actuators_[index(tyre.steer_joint)].driven = machine_.has_drive;
    }
    tyres_.push_back(tyre);
  }
  if (!machine_.has_drive) return;
  // Revolute joints inward of a wheel that neither spin nor steer let an axle oscillate.
  for (const Tyre& tyre : tyres_)
    for (int link = tyre.carrier_link; link > 0;) {
      int up = -1;
      for (std::size_t j = 0; j < machine_.joints.size(); ++j)
        if (machine_.joints[j].child == link) up = static_cast<int>(j);
      if (up < 0) break;
      const scene::Joint& joint = machine_.joints[index(up)];
      const bool known = std::find(axle_joints_.begin(), axle_joints_.end(), up) != axle_joints_.end();
      const bool steers = std::any_of(tyres_.begin(), tyres_.end(), [&](const Tyre& t) { return t.steer_joint == up; });
      if (joint.type == JointType::kRevolute && !known && !steers) {
        axle_joints_.push_back(up);
        actuators_[index(up)].driven = true;
      }
      link = joint.parent;
    }
}

void BulletMachine::add_colliders() {
  shapes_.resize(machine_.links.size());
  colliders_.resize(machine_.links.size());
  for (std::size_t i = 0; i < machine_.links.size(); ++i) {
    const int link = static_cast<int>(i), k = tree_.bullet_of_link(link);
    shapes_[i] = make_link_shape(machine_.links[i], tree_.inertial_frame(link).inverse());
    if (!shapes_[i].compound) continue;
    auto collider = std::make_unique<btMultiBodyLinkCollider>(&tree_.multibody(), k);
    collider->setCollisionShape(shapes_[i].compound.get());
    collider->setFriction(shapes_[i].friction);
    collider->setRestitution(0);
    collider->setContactStiffnessAndDamping(kContactStiffness, kContactDamping);
    collider->setActivationState(DISABLE_DEACTIVATION);
    if (k < 0)
      tree_.multibody().setBaseCollider(collider.get());
    else
      tree_.multibody().getLink(k).m_collider = collider.get();
    colliders_[i] = std::move(collider);
  }
  tree_.place_colliders();
}

void BulletMachine::add_rock() {
  for (const scene::Shell& shell : machine_.shells) {
    const int link = machine_.link_index(shell.link);
    if (link < 0) refuse("shell[" + shell.name + "]", shell.link, "no link of this name");
    rock_.push_back(std::make_unique<RockContact>(tree_, link, shell.vertices));
  }
}

void BulletMachine::set_joint(int joint, const JointInput& input) {
  Actuator& actuator = actuators_.at(index(joint));
  actuator.servo.set(input);
  actuator.driven = false;
}

void BulletMachine::set_drive(const DriveInput& input) {
  drive_input_ = input;
  for (const Tyre& tyre : tyres_) {
    actuators_[index(tyre.spin_joint)].driven = machine_.has_drive;
    if (tyre.steer_joint >= 0) actuators_[index(tyre.steer_joint)].driven = machine_.has_drive;
  }
  for (const int joint : axle_joints_) actuators_[index(joint)].driven = true;
}

void BulletMachine::add_force(int link, const Vec3& f_W, const Vec3& p_W) { pushes_.push_back({link, f_W, p_W}); }

void BulletMachine::apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W) {
  tree_.apply_impulse(link, J_W, L_W, p_W);
  external_impulse_ += J_W;
}

void BulletMachine::begin_step(const Vec3& gravity, const GroundQuery& ground, double dt) {
  for (std::size_t j = 0; j < actuators_.size(); ++j) actuators_[j].speed_before = tree_.velocity(static_cast<int>(j));
  begin_drive(dt);
  begin_joints(dt);
  push_tyres(ground, dt);
  for (const Push& push : pushes_) {
    tree_.add_force(push.link, push.f_W, Vec3::Zero(), push.p_W);
    external_impulse_ += dt * push.f_W;
  }
  pushes_.clear();
  tree_.step_velocities(gravity, dt);
}

JointLimits BulletMachine::limits(Actuator& a, const scene::Joint& about, double q) const {
  JointLimits limits;
  limits.effort_positive = limits.effort_negative = about.effort;
  limits.speed_positive = limits.speed_negative = about.velocity;
  if (a.cylinder >= 0) {
    a.hydraulic = cylinders_[index(a.cylinder)].limits(q);
    limits.effort_positive = std::min(about.effort, a.hydraulic.torque_positive);
    limits.effort_negative = std::min(about.effort, a.hydraulic.torque_negative);
    limits.speed_positive = std::min(about.velocity, a.hydraulic.speed_positive);
    limits.speed_negative = std::min(about.velocity, a.hydraulic.speed_negative);
  }
  if (a.driven && a.servo.input().mode == JointMode::kPosition) {
    limits.speed_positive = std::min(limits.speed_positive, machine_.drive.steer_rate);
    limits.speed_negative = std::min(limits.speed_negative, machine_.drive.steer_rate);
  }
  return limits;
}

double BulletMachine::oil_for(const Actuator& a, double velocity, double q) const {
  if (a.cylinder < 0) return 0;
  const scene::Cylinder& cylinder = machine_.cylinders[index(a.cylinder)];
  const double piston = velocity * cylinders_[index(a.cylinder)].geometry(q).lever;
  return std::abs(piston) * (piston > 0 ? head_area(cylinder) : rod_area(cylinder));
}

double BulletMachine::share_oil(double dt) {
  if (!machine_.has_pump) return 1;
  demands_.clear();
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    const Actuator& a = actuators_[j];
    if (a.cylinder < 0 || !constraints_[j]) continue;
    const double q = tree_.position(static_cast<int>(j));
    OilDemand demand{oil_for(a, a.opened, q), 0};
    const double most = a.opened > 0 ? a.hydraulic.torque_positive : -a.hydraulic.torque_negative;
    if (a.servo.flows() && a.effort * most > 0)
      demand.pressure = std::min(a.effort / most, 1.0) * machine_.cylinders[index(a.cylinder)].pressure;
    demands_.push_back(demand);
  }
  return pump_.share(machine_.pump, demands_, dt);
}

void BulletMachine::begin_joints(double dt) {
  const auto spins = [&](std::size_t j) {
    return std::any_of(tyres_.begin(), tyres_.end(),
                       [&](const Tyre& t) { return t.spin_joint == static_cast<int>(j); });
  };
  // Of wheels that the drive turns, it has set constraint and torque.
  const auto is_drives = [&](std::size_t j) { return actuators_[j].driven && spins(j); };
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    if (!constraints_[j] || is_drives(j)) continue;
    const int joint = static_cast<int>(j);
    Actuator& a = actuators_[j];
    const double q = tree_.position(joint);
    a.limits = limits(a, machine_.joints[j], q);
    a.limits.inertia = tree_.outward_inertia(joint);
    a.opened = a.servo.open(machine_.joints[j], a.limits, q, tree_.velocity(joint), dt);
  }
  const double share = share_oil(dt);
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    if (!constraints_[j]) continue;
    const int joint = static_cast<int>(j);
    const scene::Joint& about = machine_.joints[j];
    Actuator& a = actuators_[j];
    const double qd = tree_.velocity(joint);
    if (!is_drives(j)) {
      a.demand = a.servo.demand(about, a.limits, tree_.position(joint), qd, a.cylinder >= 0 ? share : 1.0, dt);
      constraints_[j]->command(a.demand.velocity, a.demand.effort_low * dt, a.demand.effort_high * dt);
    }
    // Viscous friction, no stronger than what stops the joint within the step.
    const double damping = about.damping > 0 ? std::min(about.damping, 0.5 * tree_.outward_inertia(joint) / dt) : 0;
    tree_.multibody().addJointTorque(tree_.bullet_of_joint(joint), a.demand.feed_forward - damping * qd);
  }
}

void BulletMachine::hold_wheel(Tyre& tyre, double torque, double dt) {
  const double q = tree_.position(tyre.spin_joint), qd = tree_.velocity(tyre.spin_joint);
  ServoConstraint& brake = *constraints_[index(tyre.spin_joint)];
  // The wheel is held where it came to rest; while it is dragged or still turns, that place goes along.
  const bool dragged = std::abs(qd) > 0.02;
  if (!tyre.braked || dragged) tyre.held_spin = q;
  tyre.braked = true;
  const double back = std::min(kBrakeGain, 0.2 / dt) * (tyre.held_spin - q);
  brake.command(back, -torque * dt, torque * dt);
}

void BulletMachine::steer_wheels() {
  const SteerAngles steer = ackermann(machine_.drive, drive_input_.steer);
  for (const Tyre& tyre : tyres_) {
    if (tyre.steer_joint < 0 || !actuators_[index(tyre.steer_joint)].driven) continue;
    const bool left = machine_.links[index(tyre.wheel_link)].X_ML.translation().y() > 0;
    actuators_[index(tyre.steer_joint)].servo.set({JointMode::kPosition, left ? steer.left : steer.right});
  }
}

void BulletMachine::lock_axles() {
  // As the service brake of a wheeled excavator does: the axle is locked for work and free for travel.
  for (const int joint : axle_joints_)
    if (actuators_[index(joint)].driven)
      actuators_[index(joint)].servo.set({drive_input_.brake ? JointMode::kVelocity : JointMode::kFree, 0});
}

void BulletMachine::begin_drive(double dt) {
  if (!machine_.has_drive) return;
  const scene::Drive& drive = machine_.drive;
  steer_wheels();
  lock_axles();
  double cage = 0, radius = 0, inertia = 0;
  int driven = 0;
  for (std::size_t w = 0; w < tyres_.size(); ++w) {
    const Tyre& tyre = tyres_[w];
    if (!machine_.wheels[w].driven || !actuators_[index(tyre.spin_joint)].driven) continue;
    cage += tree_.velocity(tyre.spin_joint);
    radius += machine_.wheels[w].radius - tyre.force.deflection;
    inertia += tyre.spin_inertia;
    ++driven;
  }
  double torque = 0;
  if (driven > 0) {
    cage /= driven;
    radius /= driven;
    if (drive_input_.brake)
      drive_train_.reset(cage * radius);
    else
      torque =
          drive_train_.wheel_torque(drive, drive_input_.speed, cage, radius, driven, tree_.total_mass(), inertia, dt);
  }
  for (std::size_t w = 0; w < tyres_.size(); ++w) {
    Tyre& tyre = tyres_[w];
    Actuator& a = actuators_[index(tyre.spin_joint)];
    if (!a.driven) continue;
    a.demand = {};
    if (drive_input_.brake) {
      hold_wheel(tyre, drive.brake_force * machine_.wheels[w].radius / static_cast<double>(tyres_.size()), dt);
    } else {
      tyre.braked = false;
      constraints_[index(tyre.spin_joint)]->command(0, 0, 0);
      a.demand.feed_forward = machine_.wheels[w].driven ? torque : 0;
    }
  }
}

Pose BulletMachine::wheel_pose(const Tyre& tyre) const {
  const Pose X_WC = tree_.link(tyre.carrier_link).X_WL;
  const Vec3 axis = X_WC.linear() * tyre.axis_C;
  Vec3 ahead = axis.cross(X_WC.linear().col(2));
  if (ahead.norm() < 0.1) ahead = axis.unitOrthogonal();
  ahead.normalize();
  Pose X = Pose::Identity();
  X.linear().col(0) = ahead;
  X.linear().col(1) = axis;
  X.linear().col(2) = ahead.cross(axis);
  X.translation() = X_WC * tyre.center_C;
  return X;
}

void BulletMachine::push_tyres(const GroundQuery& ground, double dt) {
  tyre_impulse_.setZero();
  for (std::size_t w = 0; w < tyres_.size(); ++w) {
    Tyre& tyre = tyres_[w];
    const LinkState carrier = tree_.link(tyre.carrier_link);
    TyreMotion motion;
    motion.X_WWheel = wheel_pose(tyre);
    motion.w_W = carrier.w_WL;
    motion.v_W = carrier.v_WL + carrier.w_WL.cross(motion.X_WWheel.translation() - carrier.X_WL.translation());
    motion.spin = tree_.velocity(tyre.spin_joint);
    motion.spin_inertia = tyre.spin_inertia;
    tyre.force = tyre_force(machine_.wheels[w], motion, ground, dt, tyre.state);
    tree_.add_force(tyre.wheel_link, tyre.force.force_W, tyre.force.moment_W, motion.X_WWheel.translation());
    tyre_impulse_ += dt * tyre.force.force_W;
  }
}

void BulletMachine::end_step(const Vec3& contact, double dt) {
  ground_impulse_ = tyre_impulse_ + contact;
  for (const auto& rock : rock_) {
    rock->settle();
    ground_impulse_ += rock->impulse();
  }
  tree_.step_positions(dt);
  tree_.place_colliders();
  double oil = 0;
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    if (!constraints_[j]) continue;
    Actuator& a = actuators_[j];
    const int joint = static_cast<int>(j);
    const double q = tree_.position(joint), qd = tree_.velocity(joint);
    a.effort = constraints_[j]->motor_impulse() / dt + a.demand.feed_forward;
    work_ += std::max(0.0, a.effort * 0.5 * (a.speed_before + qd) * dt);  // what a load gives back no pump recovers
    a.servo.settle(a.demand, a.limits, constraints_[j]->motor_impulse() / dt, q, qd, dt);
    // What a load pushes back goes to the tank.
    const double driven = a.servo.input().mode == JointMode::kEffort ? a.demand.feed_forward : a.opened;
    if (machine_.has_pump && driven * qd > 0) oil += oil_for(a, qd, q);
  }
  pump_.settle(oil);
}

JointState BulletMachine::joint(int joint) const {
  const Actuator& a = actuators_.at(index(joint));
  JointState state;
  state.position = tree_.position(joint);
  state.velocity = tree_.velocity(joint);
  state.effort = a.effort;
  const scene::Joint& about = machine_.joints[index(joint)];
  state.effort_limit = about.effort;
  state.velocity_limit = about.velocity;
  if (a.cylinder >= 0) {
    const CylinderMap& cylinder = cylinders_[index(a.cylinder)];
    const CylinderGeometry geometry = cylinder.geometry(state.position);
    const CylinderLimits limits = cylinder.limits(state.position);
    const bool up = state.effort >= 0;
    state.effort_limit = std::min(about.effort, up ? limits.torque_positive : limits.torque_negative);
    state.velocity_limit =
        std::min(about.velocity, state.velocity >= 0 ? limits.speed_positive : limits.speed_negative);
    state.cylinder_length = geometry.length;
    state.cylinder_force = std::abs(geometry.lever) > 1e-6 ? state.effort / geometry.lever : 0;
  }
  state.stalled = a.servo.stalled();
  return state;
}

WheelState BulletMachine::wheel(int wheel) const {
  const Tyre& tyre = tyres_.at(index(wheel));
  const LinkState carrier = tree_.link(tyre.carrier_link);
  WheelState state;
  state.X_WWheel = wheel_pose(tyre);
  state.v_W = carrier.v_WL + carrier.w_WL.cross(state.X_WWheel.translation() - carrier.X_WL.translation());
  state.spin = tree_.velocity(tyre.spin_joint);
  state.steer = tyre.steer_joint >= 0 ? tree_.position(tyre.steer_joint) : 0;
  state.force_W = tyre.force.force_W;
  state.slip = tyre.force.slip;
  state.sinkage = tyre.force.sinkage;
  return state;
}

/// Everything beside tree and servos that a step reads or an output shows, in a fixed order.
template <class Visit>
void BulletMachine::visit_state(Visit visit) {
  for (Actuator& a : actuators_) {
    visit(a.driven);
    visit(a.effort);
  }
  for (Tyre& t : tyres_) {
    for (Vec2& bristle : t.state.bristle) {
      visit(bristle.x());
      visit(bristle.y());
    }
    for (int i = 0; i < 3; ++i) {
      visit(t.force.force_W[i]);
      visit(t.force.moment_W[i]);
    }
    visit(t.force.slip);
    visit(t.force.sinkage);
    visit(t.force.deflection);
    visit(t.held_spin);
    visit(t.braked);
  }
  visit(drive_input_.speed);
  visit(drive_input_.steer);
  visit(drive_input_.brake);
  visit(work_);
  for (int i = 0; i < 3; ++i) {
    visit(ground_impulse_[i]);
    visit(external_impulse_[i]);
  }
}

void BulletMachine::hash(StateHash& hash) const {
  tree_.hash(hash);
  for (const Actuator& a : actuators_) a.servo.hash(hash);
  for (const auto& rock : rock_) rock->hash(hash);
  pump_.hash(hash);
  drive_train_.hash(hash);
  const_cast<BulletMachine*>(this)->visit_state([&](auto& v) { hash.value(v); });
}

void BulletMachine::save(StateWriter& writer) const {
  tree_.save(writer);
  for (const Actuator& a : actuators_) a.servo.save(writer);
  for (const auto& rock : rock_) rock->save(writer);
  pump_.save(writer);
  drive_train_.save(writer);
  const_cast<BulletMachine*>(this)->visit_state([&](auto& v) { writer.value(v); });
}

void BulletMachine::load(StateReader& reader) {
  tree_.load(reader);
  for (Actuator& a : actuators_) a.servo.load(reader);
  for (const auto& rock : rock_) rock->load(reader);
  pump_.load(reader);
  drive_train_.load(reader);
  visit_state([&](auto& v) { v = reader.value<std::decay_t<decltype(v)>>(); });
  pushes_.clear();
}

}  // namespace navvy::vehicle
