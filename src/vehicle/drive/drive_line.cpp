// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/drive_line.h"

#include "vehicle/drive/ackermann.h"
#include "vehicle/drive/differential.h"
#include "vehicle/drive/linkage.h"

namespace navvy::vehicle {
namespace {

// One overload a kind: a new kind does not build until it has both.
std::unique_ptr<DriveLine> line_of(const scene::AckermannDrive& drive, const std::vector<DriveWheel>& wheels) {
  return std::make_unique<AckermannLine>(drive, wheels);
}
std::unique_ptr<DriveLine> line_of(const scene::DifferentialDrive& drive, const std::vector<DriveWheel>& wheels) {
  return std::make_unique<DifferentialLine>(drive, wheels);
}
std::unique_ptr<DriveLine> line_of(const scene::LinkageDrive& drive, const std::vector<DriveWheel>& wheels) {
  return std::make_unique<LinkageLine>(drive, wheels);
}

}  // namespace

std::vector<DriveWheel> drive_wheels(const scene::Machine& machine) {
  std::vector<DriveWheel> wheels;
  for (const scene::Wheel& wheel : machine.wheels) {
    // Where nothing spins (a picture's wheel on a kinematic machine), the steered link tells the side.
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
  for (const DriveWheel& wheel : wheels) group.members.push_back(wheel.driven && wheel.left == left);
  return group;
}

void DriveLine::torques(const DriveInput& input, const std::vector<WheelTurn>& turns, double mass, double dt,
                        std::vector<double>& torque) {
  // Group by group: one governor each, from the mean of its wheels.
  torque.assign(turns.size(), 0);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    DrivenWheels wheels;
    for (std::size_t w = 0; w < turns.size(); ++w) {
      if (!group.members[w] || !turns[w].on_line) continue;
      wheels.spin += turns[w].spin;
      wheels.radius += turns[w].radius;
      wheels.spin_inertia += turns[w].spin_inertia;
      ++wheels.count;
    }
    // All taken over by joint commands: the governor waits as it is.
    if (wheels.count == 0) continue;
    // The cage of an open differential turns with the mean of its wheels.
    wheels.spin /= wheels.count;
    wheels.radius /= wheels.count;
    wheels.mass = group.share * mass;
    if (input.brake) {
      group.governor.reset(wheels.spin * wheels.radius);
      continue;
    }
    // The motor's force and power are shared out, the speed is every group's own.
    scene::Powertrain part = powertrain_;
    part.tractive_force *= group.share;
    part.power *= group.share;
    const double each = group.governor.wheel_torque(part, group_speed(input, g), wheels, dt);
    for (std::size_t w = 0; w < turns.size(); ++w)
      if (group.members[w] && turns[w].on_line) torque[w] = each;
  }
}

void DriveLine::visit(Archive& a) {
  // A snapshot of another kind of drive has another number of them.
  a.constant("governors", groups_.size(), "the drive has another number of governors than the scene's");
  for (std::size_t g = 0; g < groups_.size(); ++g) a.item(g, [&] { a("governor", groups_[g].governor); });
}

std::unique_ptr<DriveLine> make_drive_line(const scene::Machine& machine) {
  // The variant chooses; nothing else in the house asks for the kind.
  return std::visit([&](const auto& kind) { return line_of(kind, drive_wheels(machine)); }, machine.drive);
}

scene::AckermannDrive equivalent_bicycle(const scene::Drive& drive) {
  return std::visit([](const auto& kind) { return bicycle_of(kind); }, drive);
}

double steer_command(const scene::Drive& drive, double bicycle, double speed) {
  return std::visit([&](const auto& kind) { return command_of(kind, bicycle, speed); }, drive);
}

}  // namespace navvy::vehicle
