// SPDX-License-Identifier: Apache-2.0
// Ackermann steering and an open differential [Wong 2008, section 5.1].
//
//   R = L / tan(bicycle),   tan(inner) = L / (R - W/2),   tan(outer) = L / (R + W/2)
//
// R is the radius of the rear axle's middle [m], L the wheelbase [m], W the distance between king
// pins [m].
#pragma once

#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Angles of the left and right steered wheel [rad], positive to the left.
struct SteerAngles {
  double left = 0, right = 0;
};
/// Returns the wheel angles for a bicycle angle [rad] in the middle of the front axle, clamped so
/// that the inner wheel does not exceed `drive.max_steer`. All wheels roll about one centre.
SteerAngles ackermann(const scene::AckermannDrive& drive, double bicycle);
/// Returns the tangent of the bicycle angle from one wheel alone, the left or the right one, at
/// `angle` [rad]. Bounded for a wheel across the machine, which no bicycle follows.
double bicycle_tangent(const scene::AckermannDrive& drive, double angle, bool left);
/// Returns the largest bicycle angle [rad], at which the inner wheel is at `drive.max_steer`.
double max_bicycle_angle(const scene::AckermannDrive& drive);

/// Turns all driven wheels together by one governor or engine; each wheel gets the same torque.
class AckermannLine : public DriveLine {
 public:
  /// Makes the line for `drive`.
  /// @param wheels of the machine; the driven ones form one group.
  AckermannLine(const scene::AckermannDrive& drive, const std::vector<DriveWheel>& wheels);
  Roll roll(const DriveInput& input) const override;
  Roll rolled(const std::vector<WheelMotion>& motion) const override;
  double rolling_spin(const Roll& roll, const DriveWheel& wheel) const override;
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  double steer_rate() const override { return drive_.steer_rate; }
  std::vector<Coupled> differentials() const override;

 private:
  /// Returns the speed asked for; the governor itself limits it.
  double group_speed(const DriveInput& input, std::size_t group) const override;

  scene::AckermannDrive drive_;
  std::vector<DriveWheel> wheels_;
};

/// Overloads for drive_line.h, see there.
scene::AckermannDrive bicycle_of(const scene::AckermannDrive& drive);
double command_of(const scene::AckermannDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
