// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/drive_line.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vehicle/drive/ackermann.h"
#include "vehicle/drive/differential.h"
#include "vehicle/drive/linkage.h"

namespace navvy::vehicle {
namespace {

// Response time of the travel motor of a crawler or of a skid-steered machine to a speed error [s].
// All of a pump's oil flows through it, and it must turn a machine whose tracks or tyres resist
// with half its weight. With the response time of wheels, a robot asked for 0.5 rad/s reaches 0.1
// after 8 s.
constexpr double kTrackResponse = 0.05;
constexpr double kSameAxle = 0.01, kFar = 1e9;  // [m]

// One overload per kind: a new kind does not build without it.
std::unique_ptr<DriveLine> line_of(const scene::AckermannDrive& drive,
                                   const std::vector<DriveWheel>& wheels) {
  return std::make_unique<AckermannLine>(drive, wheels);
}
std::unique_ptr<DriveLine> line_of(const scene::DifferentialDrive& drive,
                                   const std::vector<DriveWheel>& wheels) {
  return std::make_unique<DifferentialLine>(drive, wheels);
}
std::unique_ptr<DriveLine> line_of(const scene::LinkageDrive& drive,
                                   const std::vector<DriveWheel>& wheels) {
  return std::make_unique<LinkageLine>(drive, wheels);
}

}  // namespace

// Reads sides and axles from the links' poses in M.
std::vector<DriveWheel> drive_wheels(const scene::Machine& machine) {
  std::vector<DriveWheel> wheels;
  for (const scene::Wheel& wheel : machine.wheels) {
    // If nothing spins (a decorative wheel of a kinematic machine), the steered link determines the
    // side.
    int joint = machine.joint_index(wheel.joint);
    if (joint < 0) joint = machine.joint_index(wheel.steer_joint);
    Vec3 p = Vec3::Zero();
    if (joint >= 0) {
      const int link = machine.joints[static_cast<std::size_t>(joint)].child;
      p = machine.links[static_cast<std::size_t>(link)].X_ML.translation();
    }
    wheels.push_back({wheel.driven, p.y() > 0, wheel.radius, p.x()});
  }
  return wheels;
}

DriveLine::Group DriveLine::all_driven(const std::vector<DriveWheel>& wheels) {
  Group group;
  for (const DriveWheel& wheel : wheels) group.members.push_back(wheel.driven);
  return group;
}

DriveLine::Group DriveLine::driven_side(const std::vector<DriveWheel>& wheels, bool left) {
  Group group;
  group.share = 0.5;
  // Several axles cannot all roll about one centre.
  double front = -kFar, rear = kFar;
  for (const DriveWheel& wheel : wheels) {
    if (!wheel.driven || wheel.left != left) continue;
    front = std::max(front, wheel.x);
    rear = std::min(rear, wheel.x);
  }
  group.skids = front - rear > kSameAxle;
  for (const DriveWheel& wheel : wheels)
    group.members.push_back(wheel.driven && wheel.left == left);
  return group;
}

DriveLine::DriveLine(const scene::Powertrain& powertrain, std::vector<Group> groups,
                     const std::optional<scene::CombustionEngine>& engine)
    : powertrain_(powertrain), groups_(std::move(groups)) {
  if (engine) engine_.emplace(*engine, powertrain.engine_power > 0);
}

std::vector<Coupled> DriveLine::coupled() const {
  std::vector<Coupled> out = differentials();
  std::erase_if(
      out, [](const Coupled& one) { return one.about.kind == scene::Differential::Kind::kOpen; });
  return out;
}

DrivenWheels DriveLine::on_line(const Group& group, const std::vector<WheelTurn>& turns,
                                double mass) {
  DrivenWheels wheels;
  for (std::size_t w = 0; w < turns.size(); ++w) {
    if (!group.members[w] || !turns[w].on_line) continue;
    wheels.spin += turns[w].spin;
    wheels.radius += turns[w].radius;
    wheels.spin_inertia += turns[w].spin_inertia;
    if (turns[w].running_track || group.skids) wheels.response = kTrackResponse;
    ++wheels.count;
  }
  if (wheels.count == 0) return wheels;
  // The carrier of an open differential turns at the mean of its wheels.
  wheels.spin /= wheels.count;
  wheels.radius /= wheels.count;
  wheels.mass = group.share * mass;
  return wheels;
}

double DriveLine::motor_torque(Group& group, double speed, const DrivenWheels& wheels, double dt,
                               double pump_power) {
  // Groups share the motor's force and power; the speed is each group's own.
  scene::Powertrain part = powertrain_;
  part.tractive_force *= group.share;
  part.power *= group.share;
  if (powertrain_.engine_power <= 0) return group.governor.wheel_torque(part, speed, wheels, dt);
  const double left = group.share * std::max(0.0, powertrain_.engine_power - pump_power);
  const double each = group.governor.wheel_torque(part, speed, wheels, dt, left);
  state_.power += std::max(0.0, each * wheels.count * wheels.spin);
  return each;
}

// The governor asks for a force; the engine limits it in the present gear.
double DriveLine::engine_torque(Group& group, const DriveInput& input, const DrivenWheels& wheels,
                                double dt, double pump_power) {
  const double most = std::min(powertrain_.max_speed, engine_->fastest(input.gear) * wheels.radius);
  const double goal = std::clamp(input.speed, -most, most);
  // The reverser follows the command, or the present rolling direction at a commanded speed of 0.
  const double sense = std::copysign(1.0, goal != 0 ? goal : wheels.spin),
               carrier = sense * wheels.spin;
  const double asked = group.governor.ask(goal, wheels, dt);
  engine_->shift(input.gear, carrier, sense * asked * wheels.radius, dt);
  const GearedEngine::Bounds most_torque = engine_->bounds(carrier, pump_power);
  if (engine_->about().kind == scene::CombustionEngine::Kind::kSpeedSource) {
    held_ = HeldCarrier{group.governor.asked() / wheels.radius, most_torque.high};
    return 0;
  }
  double low = most_torque.low / wheels.radius, high = most_torque.high / wheels.radius;
  if (sense < 0) low = -std::exchange(high, -low);
  const double torque = group.governor.give(asked, low, high, wheels, dt) * wheels.radius;
  state_ = engine_->state(carrier, sense * torque, pump_power);
  return torque / wheels.count;
}

// Wheels taken by joint commands are left out of their group.
void DriveLine::torques(const DriveInput& input, const std::vector<WheelTurn>& turns, double mass,
                        double dt, std::vector<double>& torque, double pump_power) {
  // One governor per group, from the mean of its wheels.
  torque.assign(turns.size(), 0);
  held_.reset();
  if (powertrain_.engine_power <= 0) pump_power = 0;
  state_ = engine_ ? engine_->state(0, 0, pump_power) : CombustionEngineState{0, 0, pump_power, 0};
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    const DrivenWheels wheels = on_line(group, turns, mass);
    // All taken over by joint commands: the governor keeps its state.
    if (wheels.count == 0) continue;
    if (input.brake) {
      group.governor.reset(wheels.spin * wheels.radius);
      continue;
    }
    const double each = engine_
                            ? engine_torque(group, input, wheels, dt, pump_power)
                            : motor_torque(group, group_speed(input, g), wheels, dt, pump_power);
    for (std::size_t w = 0; w < turns.size(); ++w)
      if (group.members[w] && turns[w].on_line) torque[w] = each;
  }
}

void DriveLine::settle(double carrier, double torque) {
  if (held_) state_ = engine_->state(carrier, torque, 0);
}

void DriveLine::visit(Archive& a) {
  // A snapshot of another kind of drive has another number of governors.
  a.constant("governors", groups_.size(),
             "the drive has another number of governors than the scene's");
  for (std::size_t g = 0; g < groups_.size(); ++g)
    a.item(g, [&] { a("governor", groups_[g].governor); });
  if (engine_) a("engine", *engine_);
  if (engine_ || powertrain_.engine_power > 0)
    a.unhashed("output only", [&] { a("engine_state", state_); });
}

std::unique_ptr<DriveLine> make_drive_line(const scene::Machine& machine) {
  // The variant selects the kind; no other code outside `scene` asks for it.
  return std::visit([&](const auto& kind) { return line_of(kind, drive_wheels(machine)); },
                    machine.drive);
}

scene::AckermannDrive equivalent_bicycle(const scene::Drive& drive) {
  return std::visit([](const auto& kind) { return bicycle_of(kind); }, drive);
}

double steer_command(const scene::Drive& drive, double bicycle, double speed) {
  return std::visit([&](const auto& kind) { return command_of(kind, bicycle, speed); }, drive);
}

}  // namespace navvy::vehicle
