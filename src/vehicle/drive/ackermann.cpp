// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/ackermann.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace navvy::vehicle {
namespace {

// Wheels may be commanded across the machine, where no bicycle follows. No drive's own angles reach
// these bounds.
constexpr double kLeastShare = 0.05;
constexpr double kSharpest = 20;    // tangent of a bicycle angle
constexpr double kSameAxle = 0.01;  // [m]

/// Returns -1 for a wheel behind the axle that is not steered, which turns the other way, else 1.
double turned(const DriveWheel& wheel) { return wheel.x < -kSameAxle ? -1 : 1; }

}  // namespace

double max_bicycle_angle(const scene::AckermannDrive& drive) {
  // A wheel across the machine would have an infinite tangent.
  const double inner = std::tan(std::min(drive.max_steer, radians(89)));
  return inner > 0 ? std::atan(drive.wheelbase / (drive.wheelbase / inner + 0.5 * drive.track)) : 0;
}

SteerAngles ackermann(const scene::AckermannDrive& drive, double bicycle) {
  const double most = max_bicycle_angle(drive);
  const double t = std::tan(std::clamp(bicycle, -most, most));
  // L / (R -+ W/2) with R = L / t, without dividing by a t of zero.
  const double share = 0.5 * drive.track * t / drive.wheelbase;
  return {std::atan2(t, 1 - share), std::atan2(t, 1 + share)};
}

double bicycle_tangent(const scene::AckermannDrive& drive, double angle, bool left) {
  const double t = std::tan(angle), half = 0.5 * drive.track / drive.wheelbase;
  // In a turn to the left the left wheel is the inner one.
  return std::clamp(t / std::max(left ? 1 + half * t : 1 - half * t, kLeastShare), -kSharpest,
                    kSharpest);
}

AckermannLine::AckermannLine(const scene::AckermannDrive& drive,
                             const std::vector<DriveWheel>& wheels)
    : DriveLine(drive, {all_driven(wheels)}, drive.engine), drive_(drive), wheels_(wheels) {}

Roll AckermannLine::roll(const DriveInput& input) const {
  const double speed =
      input.brake ? 0 : std::clamp(input.speed, -drive_.max_speed, drive_.max_speed);
  const double most = max_bicycle_angle(drive_);
  return {speed, speed * std::tan(std::clamp(input.steer, -most, most)) / drive_.wheelbase};
}

// Speed from the driven wheels, curvature from the steered ones.
Roll AckermannLine::rolled(const std::vector<WheelMotion>& motion) const {
  double speed = 0, tangent = 0;
  int driven = 0, steered = 0;
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    if (wheels_[w].driven) {
      speed += motion[w].spin * wheels_[w].radius;
      ++driven;
    }
    if (!motion[w].steer) continue;
    // Inconsistent angles drag a wheel, and the machine follows their mean.
    tangent += bicycle_tangent(drive_, turned(wheels_[w]) * *motion[w].steer, wheels_[w].left);
    ++steered;
  }
  speed /= std::max(driven, 1);
  return {speed, speed * tangent / std::max(steered, 1) / drive_.wheelbase};
}

double AckermannLine::rolling_spin(const Roll& roll, const DriveWheel& wheel) const {
  // Use the carrier's speed. In a turn the outer wheel is faster and the inner one slower by the
  // same amount, which matters only to engines with forces.
  return roll.speed / wheel.radius;
}

std::optional<double> AckermannLine::steer_angle(const DriveInput& input,
                                                 const DriveWheel& wheel) const {
  // Also under the brake: a standing machine turns its wheels for the next start.
  const SteerAngles steer = ackermann(drive_, input.steer);
  return turned(wheel) * (wheel.left ? steer.left : steer.right);
}

// One between the wheels of each driven axle, one between the first axle and the others.
std::vector<Coupled> AckermannLine::differentials() const {
  // Driven axles from front to rear; twin wheels of a side count as one shaft.
  std::vector<double> axles;
  for (const DriveWheel& wheel : wheels_) {
    const auto same = [&](double x) { return std::abs(x - wheel.x) < kSameAxle; };
    if (wheel.driven && std::none_of(axles.begin(), axles.end(), same)) axles.push_back(wheel.x);
  }
  std::sort(axles.rbegin(), axles.rend());
  std::vector<Coupled> out;
  const auto add = [&](std::string name, const scene::Differential& about, const auto& one,
                       const auto& other) {
    const auto ones = std::count_if(wheels_.begin(), wheels_.end(), one);
    const auto others = std::count_if(wheels_.begin(), wheels_.end(), other);
    if (ones == 0 || others == 0) return;
    Coupled& coupled = out.emplace_back(Coupled{std::move(name), about, {}});
    for (const DriveWheel& wheel : wheels_)
      coupled.weight.push_back(one(wheel)     ? 1.0 / static_cast<double>(ones)
                               : other(wheel) ? -1.0 / static_cast<double>(others)
                                              : 0.0);
  };
  for (std::size_t a = 0; a < axles.size(); ++a) {
    const auto on = [x = axles[a]](const DriveWheel& w, bool left) {
      return w.driven && w.left == left && std::abs(w.x - x) < kSameAxle;
    };
    add(
        "axle_" + std::to_string(a + 1), drive_.axles,
        [&](const DriveWheel& w) { return on(w, true); },
        [&](const DriveWheel& w) { return on(w, false); });
  }
  if (axles.size() > 1) {
    const auto front = [&](const DriveWheel& w) {
      return w.driven && std::abs(w.x - axles[0]) < kSameAxle;
    };
    add("centre", drive_.centre, front, [&](const DriveWheel& w) { return w.driven && !front(w); });
  }
  return out;
}

double AckermannLine::group_speed(const DriveInput& input, std::size_t group) const {
  (void)group;  // one group of all driven wheels; the governor limits the speed
  return input.speed;
}

scene::AckermannDrive bicycle_of(const scene::AckermannDrive& drive) { return drive; }

double command_of(const scene::AckermannDrive& drive, double bicycle, double speed) {
  (void)drive, (void)speed;
  return bicycle;
}

}  // namespace navvy::vehicle
