// SPDX-License-Identifier: Apache-2.0
// Differential drive: the left and the right side are driven separately, and their speed difference
// turns the machine.
//
//   v_left = v - w W/2,   v_right = v + w W/2
//
// v is the speed [m/s] and w the yaw rate [rad/s] of the machine's frame, W the track width [m]. A
// rolling wheel of radius r spins at v_left / r or v_right / r.
#pragma once

#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Rim speeds of the wheels on both sides of a machine.
struct SideSpeeds {
  /// Rim speed of the left and of the right wheels [m/s], positive forward.
  double left = 0, right = 0;
};
/// Returns the rim speeds for the speed and yaw rate in `input`. If a side would exceed
/// `drive.max_speed`, both are scaled by the same factor, so that the machine drives the same arc
/// more slowly. The brake in `input` is ignored.
SideSpeeds side_speeds(const scene::DifferentialDrive& drive, const DriveInput& input);

/// Drive line of a machine with differential drive. If the wheels of a side are locked to each
/// other, each side has its own governor, with half of the machine's mass, force and power, and its
/// driven wheels turn at the same speed, as through a chain. If they are independent, each driven
/// wheel has its own governor, with an even share of mass, force and power.
///
/// Each side approaches its commanded speed independently. After a new command, the machine may
/// therefore leave the commanded arc until both sides have reached their speeds.
class DifferentialLine final : public DriveLine {
 public:
  /// Makes the drive line for `drive`.
  /// @param wheels all wheels of the machine
  DifferentialLine(const scene::DifferentialDrive& drive, const std::vector<DriveWheel>& wheels);
  /// Returns the motion of the machine for the command `input`, from the limited rim speeds of both
  /// sides; zero under the brake.
  Roll roll(const DriveInput& input) const override;
  /// Returns the motion of the machine for the wheel motions in `motion`, one per wheel. Each side
  /// moves at the mean rim speed of its driven wheels.
  Roll rolled(const std::vector<WheelMotion>& motion) const override;
  /// Returns the spin [rad/s] of a wheel that rolls without slip at the speed of its side, while
  /// the machine moves by `roll`.
  double rolling_spin(const Roll& roll, const DriveWheel& wheel) const override;
  /// Returns nothing, since this drive steers no wheels. Casters swivel freely.
  std::optional<double> steer_angle(const DriveInput& input,
                                    const DriveWheel& wheel) const override;
  /// Returns infinity, since this drive steers no wheels.
  double steer_rate() const override;
  /// Returns false, since each side has its own motor and the wheels' efforts report its torque.
  bool has_shafts() const override { return false; }
  /// Returns one locked differential between each driven wheel and the next one of its side, named
  /// left_1, right_1 and so on from front to rear; nothing for one driven wheel per side or for
  /// independent wheels.
  std::vector<Coupled> differentials() const override;

 private:
  /// Makes the groups of wheels that have a governor each: the left and the right side, or each
  /// driven wheel.
  static std::vector<Group> groups_of(const scene::DifferentialDrive& drive,
                                      const std::vector<DriveWheel>& wheels);
  /// Returns true if the wheels of a group are on the left side.
  bool is_left(std::size_t group) const;
  /// Returns the commanded rim speed [m/s] of the side to which a group's wheels belong.
  double group_speed(const DriveInput& input, std::size_t group) const override;

  /// Properties of the drive as given in the scene.
  scene::DifferentialDrive drive_;
  /// Constant properties of all wheels of the machine.
  std::vector<DriveWheel> wheels_;
};

/// Returns a bicycle as long as the track width, which can follow the same arcs as `drive`;
/// overload of equivalent_bicycle() (drive_line.h) for this type of drive.
scene::AckermannDrive bicycle_of(const scene::DifferentialDrive& drive);
/// Returns the yaw rate [rad/s] that follows the arc of the angle `bicycle` [rad] at `speed` [m/s];
/// overload of steer_command() (drive_line.h) for this type of drive.
double command_of(const scene::DifferentialDrive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
