// SPDX-License-Identifier: Apache-2.0
// One motor that steers two wheels through a trapezoid: axle beam, two steering arms and a tie rod
// between their ends.
//
// Seen from above, x ahead: king pins at (0, +-W/2); with the wheels straight the arms' ends lie at
// (s a cos b, +-t/2), s = -1 behind the axle and 1 ahead of it, sin b = (t - W) / (2 a), W track
// between king pins, a length of an arm, t length of the tie rod [m]. The motor turns the left arm;
// the rod keeps the ends t apart, which turns the right one.
#pragma once

#include "vehicle/drive/ackermann.h"

namespace navvy::vehicle {

/// Angles of both wheels [rad], positive to the left, at the motor's position `motor`
/// [rad, at the motor], which is cut so that neither wheel turns further than `drive.max_steer`.
SteerAngles linkage_angles(const scene::LinkageDrive& drive, double motor);
/// Positions of the motor [rad] at which a wheel is at `drive.max_steer`: to the right (negative),
/// and to the left.
struct MotorRange {
  double right = 0, left = 0;
};
MotorRange motor_range(const scene::LinkageDrive& drive);
/// How much further than on a common centre the outer wheel is turned, for the angle of the inner
/// one [rad]: positive where it turns too far, as a parallelogram does; 0 where the wheels are
/// straight or turned against each other.
double ackermann_error(const scene::AckermannDrive& drive, const SteerAngles& angles);

/// An AckermannLine whose DriveInput::steer is the motor's position.
class LinkageLine final : public AckermannLine {
 public:
  LinkageLine(const scene::LinkageDrive& drive, const std::vector<DriveWheel>& wheels);
  Roll roll(const DriveInput& input) const override;
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;

 private:
  scene::LinkageDrive drive_;
};

/// What drive_line.h asks of every kind, see there.
scene::AckermannDrive bicycle_of(const scene::LinkageDrive& drive);
double command_of(const scene::LinkageDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
