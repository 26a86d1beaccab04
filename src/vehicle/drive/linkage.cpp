// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/linkage.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

/// Returns the angle of the other wheel [rad] with the left one at `left`. Mirrored, this is the
/// left wheel's angle for the right one's.
double across(const scene::LinkageDrive& drive, double left) {
  const double a = drive.arm, t = drive.tie_rod, half = 0.5 * drive.track;
  // Both arms with straight wheels.
  const Vec2 straight = scene::steering_arm(drive), mirrored(straight.x(), -straight.y());
  // End of the left arm, from the right king pin. The right end is `a` from that pin and `t` from
  // the left end.
  const Vec2 end = Vec2(0, 2 * half) + Eigen::Rotation2Dd(left) * straight;
  const double cosine = (end.squaredNorm() + a * a - t * t) / (2 * a * end.norm());
  const double open = std::acos(std::clamp(cosine, -1.0, 1.0));
  // Take the assembly that is continuous with straight wheels.
  const Vec2 from = Vec2(0, 2 * half) + straight;
  const double side = from.x() * mirrored.y() - from.y() * mirrored.x() < 0 ? -1 : 1;
  const double angle =
      std::atan2(end.y(), end.x()) + side * open - std::atan2(mirrored.y(), mirrored.x());
  return std::remainder(angle, 2 * kPi);
}

/// Returns the angles of both wheels, without regard to the stops.
SteerAngles angles_at(const scene::LinkageDrive& drive, double motor) {
  const double left = motor / drive.gear_ratio;
  return {left, across(drive, left)};
}

/// Returns the mean of both wheels: wheels that disagree drag.
double mean_tangent(const scene::LinkageDrive& drive, const SteerAngles& angles) {
  return 0.5 *
         (bicycle_tangent(drive, angles.left, true) + bicycle_tangent(drive, angles.right, false));
}

}  // namespace

MotorRange motor_range(const scene::LinkageDrive& drive) {
  // To the left the left wheel is the inner one; to the right it is the outer one, which turns
  // less. For an inverted linkage it is the other way round.
  const double most = drive.max_steer, outer = across(drive, most);
  return {-drive.gear_ratio * std::min(outer, most),
          drive.gear_ratio * (outer > most ? -across(drive, -most) : most)};
}

SteerAngles linkage_angles(const scene::LinkageDrive& drive, double motor) {
  const MotorRange range = motor_range(drive);
  return angles_at(drive, std::clamp(motor, range.right, range.left));
}

double ackermann_error(const scene::AckermannDrive& drive, const SteerAngles& angles) {
  if (angles.left * angles.right <= 0) return 0;
  const double inner = angles.left > 0 ? angles.left : -angles.right;
  const double outer = angles.left > 0 ? angles.right : -angles.left;
  // cot(outer) = cot(inner) + W / L.
  return outer - std::atan2(1, 1 / std::tan(inner) + drive.track / drive.wheelbase);
}

LinkageLine::LinkageLine(const scene::LinkageDrive& drive, const std::vector<DriveWheel>& wheels)
    : AckermannLine(drive, wheels), drive_(drive) {}

Roll LinkageLine::roll(const DriveInput& input) const {
  const double speed =
      input.brake ? 0 : std::clamp(input.speed, -drive_.max_speed, drive_.max_speed);
  return {speed,
          speed * mean_tangent(drive_, linkage_angles(drive_, input.steer)) / drive_.wheelbase};
}

std::optional<double> LinkageLine::steer_angle(const DriveInput& input,
                                               const DriveWheel& wheel) const {
  const SteerAngles steer = linkage_angles(drive_, input.steer);
  return wheel.left ? steer.left : steer.right;
}

scene::AckermannDrive bicycle_of(const scene::LinkageDrive& drive) { return drive; }

// The tangent grows with the motor's position. Bisect a fixed number of times, so that every run is
// bit-identical.
double command_of(const scene::LinkageDrive& drive, double bicycle, double speed) {
  (void)speed;
  const double wanted = std::tan(std::clamp(bicycle, -radians(89), radians(89)));
  MotorRange range = motor_range(drive);
  for (int i = 0; i < 52; ++i) {
    const double middle = 0.5 * (range.right + range.left);
    (mean_tangent(drive, angles_at(drive, middle)) < wanted ? range.right : range.left) = middle;
  }
  return 0.5 * (range.right + range.left);
}

}  // namespace navvy::vehicle
