// SPDX-License-Identifier: Apache-2.0
#include "control/odometry.h"

#include <cmath>
#include <vector>

#include "core/error.h"
#include "scene/drive_kinds.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::control {
namespace {

/// Returns the first driven wheel of a side that has an encoder.
CountedWheel counted_wheel(const scene::Machine& machine, bool left) {
  const std::vector<vehicle::DriveWheel> about = vehicle::drive_wheels(machine);
  for (std::size_t w = 0; w < about.size(); ++w)
    for (const scene::Encoder& encoder : machine.encoders)
      if (about[w].driven && about[w].left == left && encoder.joint == machine.wheels[w].joint)
        return {encoder.counts_per_turn / (2 * kPi * about[w].radius), encoder.bits};
  throw InputError(Fault{Fault::Severity::kError, machine.file, 0, "machine[" + machine.name + "]",
                         "",
                         std::string("odometry needs an encoder on a driven wheel on the ") +
                             (left ? "left" : "right"),
                         "add <navvy:encoder> with the wheel's joint"});
}

/// Returns sin(x) / x.
double sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

}  // namespace

std::int64_t counts_between(std::uint64_t before, std::uint64_t now, int bits) {
  const std::uint64_t range = std::uint64_t{1} << bits, passed = (now - before) & (range - 1);
  const auto up = static_cast<std::int64_t>(passed);
  return passed < range / 2 ? up : up - static_cast<std::int64_t>(range);
}

DifferentialOdometry::DifferentialOdometry(double track, const CountedWheel& left,
                                           const CountedWheel& right)
    : track_(track), left_(left), right_(right) {}

DifferentialOdometry DifferentialOdometry::of(const scene::Machine& machine) {
  const scene::DifferentialDrive* drive = scene::differential_drive(machine.drive);
  if (!machine.has_drive || drive == nullptr)
    throw InputError(Fault{Fault::Severity::kError, machine.file, 0,
                           "machine[" + machine.name + "]", "",
                           "differential odometry needs a differential drive",
                           "give the machine <navvy:drive type=\"differential\">"});
  return {drive->track, counted_wheel(machine, true), counted_wheel(machine, false)};
}

void DifferentialOdometry::reset(const PlanePose& pose, std::uint64_t left, std::uint64_t right) {
  pose_ = pose;
  distance_ = 0;
  left_before_ = left;
  right_before_ = right;
}

void DifferentialOdometry::update(std::uint64_t left, std::uint64_t right) {
  const auto rolled = [](const CountedWheel& wheel, std::uint64_t& before, std::uint64_t now) {
    const std::int64_t counts = counts_between(before, now, wheel.bits);
    before = now;
    return static_cast<double>(counts) / wheel.counts_per_metre;
  };
  const double by_left = rolled(left_, left_before_, left),
               by_right = rolled(right_, right_before_, right);
  const double length = 0.5 * (by_left + by_right), turn = (by_right - by_left) / track_;
  // The chord of the arc points along the heading midway.
  const double chord = length * sinc(0.5 * turn), heading = pose_.yaw + 0.5 * turn;
  pose_.p += chord * Vec2(std::cos(heading), std::sin(heading));
  pose_.yaw += turn;
  distance_ += length;
}

}  // namespace navvy::control
