// SPDX-License-Identifier: Apache-2.0
// Differential drive: the difference of the sides' speeds turns the machine.
//
//   v_left = v - w W/2,   v_right = v + w W/2
//
// v speed [m/s] and w yaw rate [rad/s] of the machine's frame, W track [m]; wheels spin at v_side /
// r while they roll.
#pragma once

#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Speeds of the wheels' rims [m/s], positive forwards.
struct SideSpeeds {
  double left = 0, right = 0;
};
/// For a command of speed and yaw rate. Where a side would have to exceed `drive.max_speed`, both
/// are slowed by one share: the machine goes slower but on the arc asked for. The brake is not
/// looked at.
SideSpeeds side_speeds(const scene::DifferentialDrive& drive, const DriveInput& input);

/// One governor a side; each moves half the machine with half the motor's force and power. The
/// sides follow their own speeds, so between two commands the machine may leave the arc by what the
/// sides' ramps differ.
class DifferentialLine final : public DriveLine {
 public:
  DifferentialLine(const scene::DifferentialDrive& drive, const std::vector<DriveWheel>& wheels);
  Roll roll(const DriveInput& input) const override;
  Roll rolled(const std::vector<WheelMotion>& motion) const override;
  double rolling_spin(const Roll& roll, const DriveWheel& wheel) const override;
  /// Nothing: it turns no wheels. Casters swivel by themselves.
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  double steer_rate() const override;

 private:
  double group_speed(const DriveInput& input, std::size_t group) const override;

  scene::DifferentialDrive drive_;
  std::vector<DriveWheel> wheels_;
};

/// What drive_line.h asks of every kind, see there.
scene::AckermannDrive bicycle_of(const scene::DifferentialDrive& drive);
double command_of(const scene::DifferentialDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
