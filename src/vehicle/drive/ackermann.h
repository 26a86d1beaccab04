// SPDX-License-Identifier: Apache-2.0
// Ackermann steering and an open differential [Wong 2008, section 5.1].
//
//   R = L / tan(bicycle),   tan(inner) = L / (R - W/2),   tan(outer) = L / (R + W/2)
//
// R is the radius of the rear axle's middle [m], L the wheelbase [m], W the distance between king
// pins [m]. Steered wheels behind that axle turn by the same angles the other way; they are as far
// behind it as the front ones are ahead of it.
#pragma once

#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Steering angles of the two steered wheels of an axle.
struct SteerAngles {
  /// Angles of the left and of the right wheel [rad], positive to the left.
  double left = 0, right = 0;
};
/// Returns the steering angles of both wheels for the angle `bicycle` [rad] of an imaginary single
/// wheel in the middle of the front axle. With these angles, all wheels roll about one common
/// centre. The inner wheel's angle is limited to `drive.max_steer`.
SteerAngles ackermann(const scene::AckermannDrive& drive, double bicycle);
/// Returns the tangent of the bicycle angle for which one steered wheel is at `angle` [rad]. `left`
/// selects the left or the right wheel. The result is bounded to +-20, since no bicycle angle
/// corresponds to a wheel that stands across the machine.
double bicycle_tangent(const scene::AckermannDrive& drive, double angle, bool left);
/// Returns the largest bicycle angle [rad], at which the inner wheel is at `drive.max_steer`. The
/// bicycle angle is that of an imaginary single wheel in the middle of the front axle.
double max_bicycle_angle(const scene::AckermannDrive& drive);

/// Drive line of a machine with Ackermann steering. One governor or engine turns all driven wheels
/// and gives each of them the same torque. Locked and limited-slip differentials (differentials())
/// then transfer torque between them.
class AckermannLine : public DriveLine {
 public:
  /// Makes the drive line for `drive`.
  /// @param wheels all wheels of the machine; the driven ones form one group
  AckermannLine(const scene::AckermannDrive& drive, const std::vector<DriveWheel>& wheels);
  /// Returns the motion of the machine for the command `input`: the commanded speed, and the yaw
  /// rate that follows from the bicycle angle `input.steer`, both within the drive's limits. The
  /// speed is zero under the brake.
  Roll roll(const DriveInput& input) const override;
  /// Returns the motion of the machine for the wheel motions in `motion`, one per wheel. The speed
  /// is the mean rim speed of the driven wheels; the curvature is the mean of the steered wheels.
  Roll rolled(const std::vector<WheelMotion>& motion) const override;
  /// Returns the spin [rad/s] of a wheel that rolls without slip at the machine's speed,
  /// `roll.speed`. The speed difference between inner and outer wheels is neglected.
  double rolling_spin(const Roll& roll, const DriveWheel& wheel) const override;
  /// Returns the Ackermann angle [rad] of the left or right steered wheel for the bicycle angle
  /// `input.steer`; with the opposite sign for a wheel behind the machine frame's origin.
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  /// Returns the drive's largest steering rate [rad/s].
  double steer_rate() const override { return drive_.steer_rate; }
  /// Returns one differential per driven axle, from front to rear, and a centre differential if
  /// there are several driven axles.
  std::vector<Coupled> differentials() const override;

 private:
  /// Returns the commanded speed [m/s]; the governor limits it.
  double group_speed(const DriveInput& input, std::size_t group) const override;

  /// Properties of the drive as given in the scene.
  scene::AckermannDrive drive_;
  /// Constant properties of all wheels of the machine.
  std::vector<DriveWheel> wheels_;
};

/// Returns `drive` itself; overload of equivalent_bicycle() (drive_line.h) for this type of drive.
scene::AckermannDrive bicycle_of(const scene::AckermannDrive& drive);
/// Returns the angle `bicycle` itself [rad]; overload of steer_command() (drive_line.h) for this
/// type of drive.
double command_of(const scene::AckermannDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
