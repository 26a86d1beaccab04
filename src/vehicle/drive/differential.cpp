// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/differential.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace navvy::vehicle {

using SideWheels = scene::DifferentialDrive::SideWheels;

SideSpeeds side_speeds(const scene::DifferentialDrive& drive, const DriveInput& input) {
  // Rim speed that the yaw rate adds on the right and subtracts on the left.
  const double turn = 0.5 * drive.track * input.steer;
  const double fastest = std::max(std::abs(input.speed - turn), std::abs(input.speed + turn));
  // Scale both: the ratio of yaw rate to speed, the curvature, stays the same.
  const double share = fastest > drive.max_speed ? drive.max_speed / fastest : 1;
  return {share * (input.speed - turn), share * (input.speed + turn)};
}

DifferentialLine::DifferentialLine(const scene::DifferentialDrive& drive,
                                   const std::vector<DriveWheel>& wheels)
    : DriveLine(drive, groups_of(drive, wheels)), drive_(drive), wheels_(wheels) {}

std::vector<DriveLine::Group> DifferentialLine::groups_of(const scene::DifferentialDrive& drive,
                                                          const std::vector<DriveWheel>& wheels) {
  std::vector<Group> sides = {driven_side(wheels, true), driven_side(wheels, false)};
  if (drive.side_wheels == SideWheels::kLocked) return sides;
  std::vector<Group> each;
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    if (!wheels[w].driven) continue;
    Group one;
    one.members.resize(wheels.size());
    one.members[w] = true;
    one.skids = sides[wheels[w].left ? 0 : 1].skids;
    each.push_back(std::move(one));
  }
  for (Group& one : each) one.share = 1 / static_cast<double>(each.size());
  return each;
}

// The wheels of a side as a chain from front to rear.
std::vector<Coupled> DifferentialLine::differentials() const {
  std::vector<Coupled> out;
  if (drive_.side_wheels == SideWheels::kIndependent) return out;
  scene::Differential lock;
  lock.kind = scene::Differential::Kind::kLocked;
  for (const bool left : {true, false}) {
    std::vector<std::size_t> chain;
    for (std::size_t w = 0; w < wheels_.size(); ++w)
      if (wheels_[w].driven && wheels_[w].left == left) chain.push_back(w);
    std::stable_sort(chain.begin(), chain.end(),
                     [this](std::size_t a, std::size_t b) { return wheels_[a].x > wheels_[b].x; });
    for (std::size_t i = 1; i < chain.size(); ++i) {
      Coupled pair{(left ? "left_" : "right_") + std::to_string(i), lock, {}};
      pair.weight.resize(wheels_.size());
      pair.weight[chain[i - 1]] = 1;
      pair.weight[chain[i]] = -1;
      out.push_back(std::move(pair));
    }
  }
  return out;
}

Roll DifferentialLine::roll(const DriveInput& input) const {
  if (input.brake) return {};
  const SideSpeeds sides = side_speeds(drive_, input);
  // Computed from the scaled sides, so that the wheels can reach speed and yaw rate.
  return {0.5 * (sides.left + sides.right), (sides.right - sides.left) / drive_.track};
}

// Means of both sides; their difference turns the machine.
Roll DifferentialLine::rolled(const std::vector<WheelMotion>& motion) const {
  SideSpeeds sides;
  int left = 0, right = 0;
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    if (!wheels_[w].driven) continue;
    (wheels_[w].left ? sides.left : sides.right) += motion[w].spin * wheels_[w].radius;
    ++(wheels_[w].left ? left : right);
  }
  sides.left /= std::max(left, 1);
  sides.right /= std::max(right, 1);
  return {0.5 * (sides.left + sides.right), (sides.right - sides.left) / drive_.track};
}

double DifferentialLine::rolling_spin(const Roll& roll, const DriveWheel& wheel) const {
  // A caster swivels into its direction of travel; its spin is reported as that of its side.
  return (roll.speed + (wheel.left ? -0.5 : 0.5) * drive_.track * roll.yaw_rate) / wheel.radius;
}

std::optional<double> DifferentialLine::steer_angle(const DriveInput& input,
                                                    const DriveWheel& wheel) const {
  (void)input, (void)wheel;
  return std::nullopt;
}

double DifferentialLine::steer_rate() const { return std::numeric_limits<double>::infinity(); }

bool DifferentialLine::is_left(std::size_t group) const {
  if (drive_.side_wheels == SideWheels::kLocked) return group == 0;
  // The groups of independent wheels are in the order of the driven wheels.
  std::size_t driven = 0;
  for (const DriveWheel& wheel : wheels_)
    if (wheel.driven && driven++ == group) return wheel.left;
  return false;
}

double DifferentialLine::group_speed(const DriveInput& input, std::size_t group) const {
  const SideSpeeds sides = side_speeds(drive_, input);
  return is_left(group) ? sides.left : sides.right;
}

// Curvature of the bicycle and of the drive agree at every speed.
scene::AckermannDrive bicycle_of(const scene::DifferentialDrive& drive) {
  scene::AckermannDrive bicycle;
  static_cast<scene::Powertrain&>(bicycle) = drive;
  bicycle.wheelbase = drive.track;
  bicycle.track = 0;  // the bicycle's own angle is limited
  // Inner wheels at rest: the radius is half the track width, tan = L / R = 2.
  bicycle.max_steer = std::atan(2);
  bicycle.steer_rate = std::numeric_limits<double>::infinity();
  return bicycle;
}

double command_of(const scene::DifferentialDrive& drive, double bicycle, double speed) {
  return speed * std::tan(bicycle) / bicycle_of(drive).wheelbase;
}

}  // namespace navvy::vehicle
