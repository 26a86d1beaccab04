// SPDX-License-Identifier: Apache-2.0
// Differential drive: the difference of the sides' speeds turns the machine.
//
//   v_left = v - w W/2,   v_right = v + w W/2
//
// v is the speed [m/s] and w the yaw rate [rad/s] of the machine's frame, W the track width [m];
// rolling wheels spin at v_side / r.
#pragma once

#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Speeds of the wheels' rims [m/s], positive forwards.
struct SideSpeeds {
  double left = 0, right = 0;
};
/// Returns the rim speeds for a command of speed and yaw rate. If a side would exceed
/// `drive.max_speed`, both are scaled by the same factor: the machine is slower but stays on the
/// arc. Ignores the brake.
SideSpeeds side_speeds(const scene::DifferentialDrive& drive, const DriveInput& input);

/// Turns each side by its own governor, with half the machine's mass, force and power. The sides
/// follow their own speeds, so between two commands the machine may leave the arc by the difference
/// of their ramps.
class DifferentialLine final : public DriveLine {
 public:
  DifferentialLine(const scene::DifferentialDrive& drive, const std::vector<DriveWheel>& wheels);
  Roll roll(const DriveInput& input) const override;
  Roll rolled(const std::vector<WheelMotion>& motion) const override;
  double rolling_spin(const Roll& roll, const DriveWheel& wheel) const override;
  /// Returns nothing: the drive turns no wheels. Casters swivel freely.
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  double steer_rate() const override;
  /// Returns false: each wheel has a motor of its own.
  bool has_shafts() const override { return false; }

 private:
  double group_speed(const DriveInput& input, std::size_t group) const override;

  scene::DifferentialDrive drive_;
  std::vector<DriveWheel> wheels_;
};

/// Overloads for drive_line.h, see there.
scene::AckermannDrive bicycle_of(const scene::DifferentialDrive& drive);
double command_of(const scene::DifferentialDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
