// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/machine_drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace navvy::vehicle {
namespace {

constexpr double kBrakeGain = 10;  // [1/s] back to the angle at which the wheel was stopped
constexpr double kHeld = 1e9;      // [N m] beyond all torques of a locked differential
constexpr double kDragged = 0.02;  // [rad/s] a braked wheel that turns faster has lost its hold

}  // namespace

MachineDrive::MachineDrive(const scene::Machine& machine, TreeBody& tree, MachineJoints& joints,
                           MachineWheels& wheels)
    : machine_(machine),
      tree_(tree),
      joints_(joints),
      wheels_(wheels),
      line_(make_drive_line(machine)),
      about_(drive_wheels(machine)),
      turns_(wheels.size()),
      torque_(wheels.size()),
      shaft_(wheels.size()) {
  // Joints now know which of them spin wheels. Those get their torque here, not from a servo.
  joints.set_drive_rate(line_->steer_rate());
  for (const MachineWheel& wheel : wheels.all()) {
    joints[wheel.spin_joint].spins_wheel = true;
    // A trailer's wheels; a joint command may still drive them as motors.
    if (!machine.has_drive) joints[wheel.spin_joint].servo.set({JointMode::kFree, 0});
  }
  if (machine.has_drive) {
    find_axles();
    coupled_ = line_->coupled();
    const scene::CombustionEngine* engine = scene::drive_engine(machine.drive);
    const auto driven = std::count_if(about_.begin(), about_.end(),
                                      [](const DriveWheel& wheel) { return wheel.driven; });
    if (engine != nullptr && engine->kind == scene::CombustionEngine::Kind::kSpeedSource &&
        driven > 0)
      for (const DriveWheel& wheel : about_)
        carrier_.push_back(wheel.driven ? 1.0 / static_cast<double>(driven) : 0.0);
  }
  for (const Coupled& coupled : coupled_) add_row(coupled.weight);
  if (!carrier_.empty()) add_row(carrier_);
  set(input_);
}

void MachineDrive::add_row(const std::vector<double>& weight) {
  std::vector<std::pair<int, double>> weights;
  for (std::size_t w = 0; w < wheels_.size(); ++w)
    if (weight[w] != 0)
      weights.emplace_back(tree_.bullet_of_joint(wheels_[w].spin_joint), weight[w]);
  rows_.push_back(std::make_unique<DifferentialRow>(&tree_.multibody(), weights));
}

// Follows the links from each wheel to the chassis.
void MachineDrive::find_axles() {
  // Revolute joints inward of a wheel that neither spin nor steer let an axle oscillate, or a
  // caster swivel.
  for (const MachineWheel& wheel : wheels_.all())
    // Walk from the wheel's carrier inward, joint by joint, to the chassis.
    for (int link = wheel.carrier_link; link > 0;) {
      int up = -1;
      for (std::size_t j = 0; j < machine_.joints.size(); ++j)
        if (machine_.joints[j].child == link) up = static_cast<int>(j);
      if (up < 0) break;
      const scene::Joint& joint = machine_.joints[static_cast<std::size_t>(up)];
      const bool known = std::find(axles_.begin(), axles_.end(), up) != axles_.end();
      const bool steers = std::any_of(wheels_.all().begin(), wheels_.all().end(),
                                      [&](const MachineWheel& w) { return w.steer_joint == up; });
      // A suspension is no axle to lock: the drive leaves passive joints alone.
      if (joint.type == scene::Joint::Type::kRevolute && !joint.passive && !known && !steers)
        axles_.push_back(up);
      link = joint.parent;
    }
}

void MachineDrive::set(const DriveInput& input) {
  input_ = input;
  for (const MachineWheel& wheel : wheels_.all()) {
    joints_[wheel.spin_joint].driven = machine_.has_drive;
    if (wheel.steer_joint >= 0) joints_[wheel.steer_joint].driven = machine_.has_drive;
  }
  for (const int joint : axles_) joints_[joint].driven = true;
}

// Steering and axle locks are joint commands; wheels get torques.
void MachineDrive::begin_step(double dt) {
  if (!machine_.has_drive) return;
  steer();
  lock_axles();
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const MachineWheel& wheel = wheels_[w];
    turns_[w] = {about_[w].driven && joints_[wheel.spin_joint].driven,
                 tree_.velocity(wheel.spin_joint), about_[w].radius - wheel.force.deflection,
                 wheel.spin_inertia, machine_.wheels[w].track.has_value()};
  }
  // Compute torques from present speeds; the governors advance by one step.
  const HydraulicPump& pump = joints_.pump();
  line_->torques(input_, turns_, tree_.total_mass(), dt, torque_, pump.flow() * pump.pressure());
  couple(dt);
  // Every wheel has a brake, driven or not, and each holds its part.
  const double brake_force = scene::powertrain(machine_.drive).brake_force;
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    MachineWheel& wheel = wheels_[w];
    Actuator& a = joints_[wheel.spin_joint];
    if (!a.driven) continue;
    // No servo acts on a wheel of the drive: it is free with a torque, or held by the brake's row.
    a.demand = {};
    if (input_.brake) {
      brake(wheel, brake_force * about_[w].radius / static_cast<double>(wheels_.size()), dt);
    } else {
      wheel.braked = false;
      // Rolling: no row, the torque is a feed-forward.
      joints_.servo(wheel.spin_joint).command(0, 0, 0);
      a.demand.feed_forward = torque_[w];
    }
  }
}

// Limited slip depends on the torque through the differential.
void MachineDrive::couple(double dt) {
  for (std::size_t d = 0; d < coupled_.size(); ++d) {
    const scene::Differential& about = coupled_[d].about;
    double through = 0;
    bool whole = !input_.brake;  // each wheel has its own brake
    for (std::size_t w = 0; w < wheels_.size(); ++w) {
      if (coupled_[d].weight[w] == 0) continue;
      // The torque of a speed source is known only after the step.
      through += std::abs(carrier_.empty() ? torque_[w] : shaft_[w]);
      whole = whole && turns_[w].on_line;
    }
    // One side gains what the other loses, so they differ by twice the row's torque.
    const double torque = about.kind == scene::Differential::Kind::kLocked
                              ? kHeld
                              : 0.5 * (about.preload + about.bias * through);
    rows_[d]->limit(whole ? torque * dt : 0);
  }
  if (carrier_.empty()) return;
  // A wheel taken over by an input leaves the others without a differential.
  bool whole = line_->held().has_value();
  double loaded = 0, unloaded = 0;
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    whole = whole && (carrier_[w] == 0 || turns_[w].on_line);
    loaded += carrier_[w] * turns_[w].radius;
    unloaded += carrier_[w] * about_[w].radius;
  }
  // The motor turns at its speed, however much the tyres deflect: the speed refers to the unloaded
  // rims.
  if (whole)
    rows_.back()->limit(line_->held()->torque * dt, line_->held()->speed * loaded / unloaded);
  else
    rows_.back()->limit(0);
}

// Splits the rows' impulses into shaft torques.
void MachineDrive::end_step(double dt) {
  if (!machine_.has_drive) return;
  shaft_ = torque_;
  for (std::size_t d = 0; d < coupled_.size(); ++d)
    for (std::size_t w = 0; w < shaft_.size(); ++w)
      shaft_[w] += coupled_[d].weight[w] * rows_[d]->impulse() / dt;
  if (carrier_.empty()) return;
  const double torque = rows_.back()->impulse() / dt;
  double speed = 0;
  for (std::size_t w = 0; w < carrier_.size(); ++w)
    speed += carrier_[w] * tree_.velocity(wheels_[w].spin_joint);
  line_->settle(speed, torque);
  for (std::size_t w = 0; w < shaft_.size(); ++w) {
    if (carrier_[w] == 0 || !turns_[w].on_line) continue;
    shaft_[w] += carrier_[w] * torque;
    // Set it as if it had been known before: effort and work of the joint are computed from it.
    joints_[wheels_[w].spin_joint].demand.feed_forward += carrier_[w] * torque;
  }
}

void MachineDrive::steer() {
  // Set the position of the steering joint's servo, which moves at the drive's rate.
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const int joint = wheels_[w].steer_joint;
    if (joint < 0 || !joints_[joint].driven) continue;
    if (const auto angle = line_->steer_angle(input_, about_[w]))
      joints_[joint].servo.set({JointMode::kPosition, *angle});
  }
}

void MachineDrive::lock_axles() {
  // Like the service brake of a wheeled excavator, lock the axle for work and free it for travel.
  for (const int joint : axles_)
    if (joints_[joint].driven)
      joints_[joint].servo.set({input_.brake ? JointMode::kVelocity : JointMode::kFree, 0});
}

void MachineDrive::brake(MachineWheel& wheel, double torque, double dt) {
  const double q = tree_.position(wheel.spin_joint), qd = tree_.velocity(wheel.spin_joint);
  // Hold the wheel where it came to rest. While it is dragged or still turns, that angle follows.
  const bool dragged = std::abs(qd) > kDragged;
  if (!wheel.braked || dragged) wheel.held_spin = q;
  wheel.braked = true;
  // Return gently, with at most the brake's torque: on a slope the machine neither creeps nor
  // trembles.
  const double back = std::min(kBrakeGain, 0.2 / dt) * (wheel.held_spin - q);
  joints_.servo(wheel.spin_joint).command(back, -torque * dt, torque * dt);
}

// Shaft torques are outputs, except that limited slip reads them with a speed source.
void MachineDrive::visit(Archive& a) {
  a("line", *line_);
  a("input", input_);
  if (const scene::CombustionEngine* engine = scene::drive_engine(machine_.drive))
    a.ranged("gear", input_.gear, 0, static_cast<int>(engine->gears.size()));
  // With a speed source, limited slip depends on this torque. Otherwise it is only reported, and
  // without rows it is the joints' effort.
  if (!carrier_.empty()) {
    a.fixed("shaft", shaft_);
  } else if (!rows_.empty()) {
    a.unhashed("output only", [&] { a.fixed("shaft", shaft_); });
  } else if (a.loading()) {
    for (std::size_t w = 0; w < shaft_.size(); ++w)
      shaft_[w] = about_[w].driven && joints_[wheels_[w].spin_joint].driven && !wheels_[w].braked
                      ? joints_[wheels_[w].spin_joint].effort
                      : 0;
  }
}

}  // namespace navvy::vehicle
