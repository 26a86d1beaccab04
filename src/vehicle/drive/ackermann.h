// SPDX-License-Identifier: Apache-2.0
// Ackermann steering and an open differential [Wong 2008, section 5.1].
//
//   R = L / tan(bicycle),   tan(inner) = L / (R - W/2),   tan(outer) = L / (R + W/2)
//
// R radius of the rear axle's middle [m], L wheelbase [m], W track between king pins [m].
#pragma once

#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Angles of the left and right steered wheel [rad], positive to the left.
struct SteerAngles {
  double left = 0, right = 0;
};
/// For a bicycle angle [rad] in the middle of the front axle, which is cut so that the inner wheel
/// keeps within `drive.max_steer`. At one angle all wheels roll about one centre.
SteerAngles ackermann(const scene::AckermannDrive& drive, double bicycle);
/// The other way round: tangent of the bicycle's angle by one wheel alone, the left or the right
/// one, at `angle` [rad]; bounded where the wheel stands across the machine and no bicycle follows.
double bicycle_tangent(const scene::AckermannDrive& drive, double angle, bool left);
/// Largest bicycle angle [rad]: the one at which the inner wheel is at `drive.max_steer`.
double max_bicycle_angle(const scene::AckermannDrive& drive);

/// One governor, or an engine, turns all driven wheels together; each gets the same torque.
class AckermannLine : public DriveLine {
 public:
  /// @param wheels of the machine; the driven ones are one group.
  AckermannLine(const scene::AckermannDrive& drive, const std::vector<DriveWheel>& wheels);
  Roll roll(const DriveInput& input) const override;
  Roll rolled(const std::vector<WheelMotion>& motion) const override;
  double rolling_spin(const Roll& roll, const DriveWheel& wheel) const override;
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  double steer_rate() const override { return drive_.steer_rate; }
  std::vector<Coupled> differentials() const override;

 private:
  /// The speed asked for: the governor itself knows the largest.
  double group_speed(const DriveInput& input, std::size_t group) const override;

  scene::AckermannDrive drive_;
  std::vector<DriveWheel> wheels_;
};

/// What drive_line.h asks of every kind, see there.
scene::AckermannDrive bicycle_of(const scene::AckermannDrive& drive);
double command_of(const scene::AckermannDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
