// SPDX-License-Identifier: Apache-2.0
#include "control/odometry.h"

#include <cmath>
#include <optional>
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

/// Returns the encoder on the joint of a wheel, null if there is none.
const scene::Encoder* encoder_of(const scene::Machine& machine, const scene::Wheel& wheel) {
  for (const scene::Encoder& encoder : machine.encoders)
    if (encoder.joint == wheel.joint) return &encoder;
  return nullptr;
}

/// Returns the position in M of a wheel, or of the middle of a track's rollers.
Vec3 place_of(const scene::Machine& machine, const scene::Wheel& wheel) {
  const scene::Joint& joint =
      machine.joints.at(static_cast<std::size_t>(machine.joint_index(wheel.joint)));
  Vec3 p = machine.links.at(static_cast<std::size_t>(joint.child)).X_ML.translation();
  if (!wheel.track || wheel.track->rollers.empty()) return p;
  Vec3 sum = Vec3::Zero();
  for (const Vec3& roller : wheel.track->rollers) sum += roller;
  // Rollers are given in the frame of the link that carries the track.
  const Pose& X_ML = machine.links.at(static_cast<std::size_t>(joint.parent)).X_ML;
  p.x() = (X_ML * Vec3(sum / static_cast<double>(wheel.track->rollers.size()))).x();
  return p;
}

/// Returns true for a wheel with an encoder that the base link carries and that is not steered, and
/// that is driven if the drive is a differential one.
bool counts_for_odometry(const scene::Machine& machine, const scene::Wheel& wheel,
                         bool differential) {
  const int joint = machine.joint_index(wheel.joint);
  return joint >= 0 && machine.joints[static_cast<std::size_t>(joint)].parent == 0 &&
         wheel.steer_joint.empty() && encoder_of(machine, wheel) != nullptr &&
         (wheel.driven || !differential);
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

std::optional<WheelOdometry> wheel_odometry(const scene::Machine& machine) {
  const scene::DifferentialDrive* drive =
      machine.has_drive ? scene::differential_drive(machine.drive) : nullptr;
  std::vector<const scene::Wheel*> left, right;
  for (const scene::Wheel& wheel : machine.wheels)
    if (counts_for_odometry(machine, wheel, drive != nullptr))
      (place_of(machine, wheel).y() > 0 ? left : right).push_back(&wheel);
  for (const scene::Wheel* l : left)
    for (const scene::Wheel* r : right) {
      const Vec3 p_l = place_of(machine, *l), p_r = place_of(machine, *r);
      // Wheels of one axle; a millimetre is the rounding of a model's numbers.
      if (std::abs(p_l.x() - p_r.x()) > 1e-3) continue;
      const auto counted = [&](const scene::Wheel& wheel) {
        const scene::Encoder& encoder = *encoder_of(machine, wheel);
        return CountedWheel{encoder.counts_per_turn / (2 * kPi * wheel.radius), encoder.bits};
      };
      const double track = drive != nullptr ? drive->track : p_l.y() - p_r.y();
      WheelOdometry out{DifferentialOdometry(track, counted(*l), counted(*r)),
                        machine.joint_index(l->joint), machine.joint_index(r->joint),
                        Vec2(0.5 * (p_l + p_r).head<2>())};
      if (drive == nullptr) return out;
      // Skid steering turns about the middle of all wheels that the drive turns.
      double sum = 0;
      int count = 0;
      for (const scene::Wheel& wheel : machine.wheels)
        if (wheel.driven && machine.joint_index(wheel.joint) >= 0)
          sum += place_of(machine, wheel).x(), ++count;
      out.p_M.x() = sum / count;
      return out;
    }
  return {};
}

}  // namespace navvy::control
