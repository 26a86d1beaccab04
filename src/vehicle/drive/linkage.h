// SPDX-License-Identifier: Apache-2.0
// Steering by one motor that turns two wheels through a trapezoid: axle beam, two steering arms and
// a tie rod between their ends.
//
// Seen from above, x ahead: king pins are at (0, +-W/2). With straight wheels the arms' ends are at
// (s a cos b, +-t/2), s = -1 behind the axle and 1 ahead of it, sin b = (t - W) / (2 a), W distance
// between king pins, a length of an arm, t length of the tie rod [m]. The motor turns the left arm;
// the rod keeps the ends t apart, which turns the right one.
#pragma once

#include "vehicle/drive/ackermann.h"

namespace navvy::vehicle {

/// Returns the angles of both wheels [rad], positive to the left, at the motor's position `motor`
/// [rad, at the motor]. It is clamped so that neither wheel turns further than `drive.max_steer`.
SteerAngles linkage_angles(const scene::LinkageDrive& drive, double motor);
/// Positions of the motor [rad] at which a wheel is at `drive.max_steer`: to the right (negative),
/// and to the left.
struct MotorRange {
  double right = 0, left = 0;
};
/// Returns the range of the motor.
MotorRange motor_range(const scene::LinkageDrive& drive);
/// Returns how much further the outer wheel is turned than a common centre asks for, for the angle
/// of the inner one [rad]. Positive if it turns too far, as in a parallelogram; 0 if the wheels are
/// straight or turned against each other.
double ackermann_error(const scene::AckermannDrive& drive, const SteerAngles& angles);

/// AckermannLine whose DriveInput::steer is the motor's position.
class LinkageLine final : public AckermannLine {
 public:
  LinkageLine(const scene::LinkageDrive& drive, const std::vector<DriveWheel>& wheels);
  Roll roll(const DriveInput& input) const override;
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  std::optional<double> steering_error(double left, double right) const override {
    return ackermann_error(drive_, {left, right});
  }

 private:
  scene::LinkageDrive drive_;
};

/// Overloads for drive_line.h, see there.
scene::AckermannDrive bicycle_of(const scene::LinkageDrive& drive);
double command_of(const scene::LinkageDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
