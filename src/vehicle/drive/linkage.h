// SPDX-License-Identifier: Apache-2.0
// Steering linkage: one motor turns two wheels through a trapezoid of axle beam, two steering arms
// and a tie rod between the ends of the arms.
//
// Seen from above with x forward, the king pins are at (0, +-W/2). With the wheels straight, the
// ends of the arms are at (s a cos b, +-t/2), sin b = (t - W) / (2 a). W is the distance between
// the king pins [m], a the length of an arm [m], t the length of the tie rod [m], and s is 1 for
// arms ahead of the axle, -1 for arms behind it. The motor turns the left arm; the rod keeps the
// ends of the arms at the distance t and so turns the right arm.
#pragma once

#include "vehicle/drive/ackermann.h"

namespace navvy::vehicle {

/// Returns the angles of both wheels [rad] at the steering motor's position `motor` [rad], all
/// positive to the left. The position is clamped so that no wheel turns further than
/// `drive.max_steer`.
SteerAngles linkage_angles(const scene::LinkageDrive& drive, double motor);
/// Range of the steering motor's position.
struct MotorRange {
  /// Motor positions [rad] at which a wheel reaches `max_steer` when turning to the right
  /// (negative) and to the left (positive).
  double right = 0, left = 0;
};
/// Returns the range of the steering motor's position, at whose ends a wheel is at
/// `drive.max_steer`.
MotorRange motor_range(const scene::LinkageDrive& drive);
/// Returns the steering error [rad]: the angle of the outer wheel minus the angle at which it would
/// roll about a common centre with the inner wheel.
///
/// The error is positive if the outer wheel is turned too far, as in a parallelogram linkage. It is
/// 0 if a wheel is straight or if both are turned in opposite directions.
double ackermann_error(const scene::AckermannDrive& drive, const SteerAngles& angles);

/// Drive line of a machine with a steering linkage: an AckermannLine whose steering command,
/// DriveInput::steer, is the position of the steering motor.
class LinkageLine final : public AckermannLine {
 public:
  /// Makes the drive line for `drive`.
  /// @param wheels all wheels of the machine; the driven ones form one group
  LinkageLine(const scene::LinkageDrive& drive, const std::vector<DriveWheel>& wheels);
  /// Returns the motion of the machine for the command `input`, whose `steer` is the position of
  /// the steering motor. The curvature is the mean of both steered wheels; the speed is zero under
  /// the brake.
  Roll roll(const DriveInput& input) const override;
  /// Returns the angle [rad] of the left or right steered wheel for the motor position
  /// `input.steer`.
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  /// Returns ackermann_error() for the wheel angles `left` and `right` [rad].
  std::optional<double> steering_error(double left, double right) const override {
    return ackermann_error(drive_, {left, right});
  }

 private:
  /// Properties of drive and linkage as given in the scene.
  scene::LinkageDrive drive_;
};

/// Returns `drive` without its linkage; overload of equivalent_bicycle() (drive_line.h) for this
/// type of drive.
scene::AckermannDrive bicycle_of(const scene::LinkageDrive& drive);
/// Returns the motor position [rad] that follows the arc of the angle `bicycle` [rad]; `speed` has
/// no effect. Overload of steer_command() (drive_line.h) for this type of drive.
double command_of(const scene::LinkageDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
