// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace navvy::vehicle {
namespace {

constexpr double kBrakeGain = 10;  // [1/s] back to the angle at which the wheel was stopped
constexpr double kHeld = 1e9;      // [N m] beyond all that a locked differential is asked for
constexpr double kDragged = 0.02;  // [rad/s] a braked wheel that turns faster has lost its hold

}  // namespace

MachineDrive::MachineDrive(const scene::Machine& machine, TreeBody& tree, MachineJoints& joints, MachineWheels& wheels)
    : machine_(machine),
      tree_(tree),
      joints_(joints),
      wheels_(wheels),
      line_(make_drive_line(machine)),
      about_(drive_wheels(machine)),
      turns_(wheels.size()) {
  // From here on joints know which of them wheels spin on: those get their torque here, not from a servo.
  joints.set_drive_rate(line_->steer_rate());
  for (const MachineWheel& wheel : wheels.all()) {
    joints[wheel.spin_joint].spins_wheel = true;
    // A trailer's wheels; a joint command may still take them as motors.
    if (!machine.has_drive) joints[wheel.spin_joint].servo.set({JointMode::kFree, 0});
  }
  if (machine.has_drive) {
    find_axles();
    coupled_ = line_->coupled();
  }
  for (const Coupled& coupled : coupled_) {
    std::vector<std::pair<int, double>> weights;
    for (std::size_t w = 0; w < wheels.size(); ++w)
      if (coupled.weight[w] != 0) weights.emplace_back(tree.bullet_of_joint(wheels[w].spin_joint), coupled.weight[w]);
    rows_.push_back(std::make_unique<DifferentialRow>(&tree.multibody(), weights));
  }
  set(input_);
}

void MachineDrive::find_axles() {
  // Revolute joints inward of a wheel that neither spin nor steer let an axle oscillate, or a caster swivel.
  for (const MachineWheel& wheel : wheels_.all())
    // From the wheel's carrier inward, joint by joint, until the chassis.
    for (int link = wheel.carrier_link; link > 0;) {
      int up = -1;
      for (std::size_t j = 0; j < machine_.joints.size(); ++j)
        if (machine_.joints[j].child == link) up = static_cast<int>(j);
      if (up < 0) break;
      const scene::Joint& joint = machine_.joints[static_cast<std::size_t>(up)];
      const bool known = std::find(axles_.begin(), axles_.end(), up) != axles_.end();
      const bool steers = std::any_of(wheels_.all().begin(), wheels_.all().end(),
                                      [&](const MachineWheel& w) { return w.steer_joint == up; });
      if (joint.type == scene::Joint::Type::kRevolute && !known && !steers) axles_.push_back(up);
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

void MachineDrive::begin_step(double dt) {
  if (!machine_.has_drive) return;
  steer();
  lock_axles();
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const MachineWheel& wheel = wheels_[w];
    turns_[w] = {about_[w].driven && joints_[wheel.spin_joint].driven, tree_.velocity(wheel.spin_joint),
                 about_[w].radius - wheel.force.deflection, wheel.spin_inertia};
  }
  // Present speeds go in, torques come out; the governors' memory moves on by one step.
  line_->torques(input_, turns_, tree_.total_mass(), dt, torque_);
  couple(dt);
  // Every wheel has a brake, driven or not; each holds its part.
  const double brake_force = scene::powertrain(machine_.drive).brake_force;
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    MachineWheel& wheel = wheels_[w];
    Actuator& a = joints_[wheel.spin_joint];
    if (!a.driven) continue;
    // No servo acts on a wheel of the drive: free with a torque, or held by the brake's row.
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

void MachineDrive::couple(double dt) {
  for (std::size_t d = 0; d < rows_.size(); ++d) {
    const scene::Differential& about = coupled_[d].about;
    double through = 0;
    bool whole = !input_.brake;  // wheels are held each by its brake
    for (std::size_t w = 0; w < wheels_.size(); ++w) {
      if (coupled_[d].weight[w] == 0) continue;
      through += std::abs(torque_[w]);
      whole = whole && turns_[w].on_line;
    }
    // One side gets what the other loses, so they differ by twice the row's torque.
    const double torque =
        about.kind == scene::Differential::Kind::kLocked ? kHeld : 0.5 * (about.preload + about.bias * through);
    rows_[d]->limit(whole ? torque * dt : 0);
  }
}

void MachineDrive::steer() {
  // A position for the steering joint's servo, which gets there at the drive's rate.
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const int joint = wheels_[w].steer_joint;
    if (joint < 0 || !joints_[joint].driven) continue;
    if (const auto angle = line_->steer_angle(input_, about_[w]))
      joints_[joint].servo.set({JointMode::kPosition, *angle});
  }
}

void MachineDrive::lock_axles() {
  // As the service brake of a wheeled excavator does: the axle is locked for work and free for travel.
  for (const int joint : axles_)
    if (joints_[joint].driven) joints_[joint].servo.set({input_.brake ? JointMode::kVelocity : JointMode::kFree, 0});
}

void MachineDrive::brake(MachineWheel& wheel, double torque, double dt) {
  const double q = tree_.position(wheel.spin_joint), qd = tree_.velocity(wheel.spin_joint);
  // The wheel is held where it came to rest; while it is dragged or still turns, that place goes along.
  const bool dragged = std::abs(qd) > kDragged;
  if (!wheel.braked || dragged) wheel.held_spin = q;
  wheel.braked = true;
  // Back to it gently, with the brake's torque at most: on a slope the machine neither creeps nor trembles.
  const double back = std::min(kBrakeGain, 0.2 / dt) * (wheel.held_spin - q);
  joints_.servo(wheel.spin_joint).command(back, -torque * dt, torque * dt);
}

void MachineDrive::visit(Archive& a) {
  a("line", *line_);
  a("input", input_);
}

}  // namespace navvy::vehicle
