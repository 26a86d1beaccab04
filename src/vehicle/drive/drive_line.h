// SPDX-License-Identifier: Apache-2.0
// What a drive command means for every wheel of a machine. One class a kind of drive, used by all
// engines.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/archive.h"
#include "scene/machine.h"
#include "vehicle/drive/drive_input.h"
#include "vehicle/drive/geared_engine.h"
#include "vehicle/drive/governor.h"

namespace navvy::vehicle {

/// A wheel as a drive line sees it: what never changes.
struct DriveWheel {
  bool driven = false;
  bool left = false;  ///< of the machine's middle: its link lies at y > 0 in M
  double radius = 0;  ///< unloaded [m]
  double x = 0;       ///< of its link in M [m]: wheels of one axle have the same
};
/// One for each of machine.wheels.
std::vector<DriveWheel> drive_wheels(const scene::Machine& machine);

/// A differential of the line. Its cage turns with half the sum of |weight| x spin, and its torque
/// is the sum of its shafts'.
struct Coupled {
  /// axle_1 of the foremost driven axle and so on, centre between that and the others.
  std::string name;
  scene::Differential about;
  /// By wheel [-]: of the shafts' difference in speed, sum of weight x spin.
  std::vector<double> weight;
};

/// A cage that turns as it is told, over the next step.
struct HeldCarrier {
  double speed = 0;   ///< [rad/s]
  double torque = 0;  ///< at most [N m]
};

/// A wheel as it turns at the start of a step.
struct WheelTurn {
  /// Driven, and the drive commands it (not a joint command that took it over).
  bool on_line = false;
  double spin = 0;             ///< positive rolls forward [rad/s]
  double radius = 0;           ///< loaded [m]
  double spin_inertia = 0;     ///< [kg m2]
  bool running_track = false;  ///< a sprocket
};

/// How a wheel moves, for engines that move the machine by it.
struct WheelMotion {
  double spin = 0;              ///< positive rolls forward [rad/s]
  std::optional<double> steer;  ///< of its steering joint [rad]; none: it has none
};

/// How the machine's frame moves while no wheel slips.
struct Roll {
  double speed = 0;     ///< along x of M [m/s]
  double yaw_rate = 0;  ///< positive to the left [rad/s]
};

/// The drive line of one machine.
///
/// Kinematics (roll, rolling_spin, steer_angle) is a function of the command alone: an engine
/// without forces moves by it, one with forces turns steered joints by it. Torques have a memory,
/// the governors'; it is saved and hashed.
class DriveLine {
 public:
  virtual ~DriveLine() = default;

  /// Where the command takes the machine, its limits of speed and steering kept; nowhere under the
  /// brake. Yaw rate is speed x curvature for a kind that steers by an angle.
  virtual Roll roll(const DriveInput& input) const = 0;
  /// Where wheels take the machine that turn and are steered so, `motion` by wheel: the mean of the
  /// driven wheels of a side, or of all, rolls without slip; the others follow.
  virtual Roll rolled(const std::vector<WheelMotion>& motion) const = 0;
  /// Spin [rad/s] of a wheel that rolls along.
  virtual double rolling_spin(const Roll& roll, const DriveWheel& wheel) const = 0;
  /// Angle [rad] of a wheel's steering joint; nothing from a kind that does not turn wheels.
  virtual std::optional<double> steer_angle(const DriveInput& input,
                                            const DriveWheel& wheel) const = 0;
  /// Fastest turning of a steering joint [rad/s].
  virtual double steer_rate() const = 0;

  /// Those of the line, of a kind that has any.
  virtual std::vector<Coupled> differentials() const { return {}; }
  /// Those of them that hold their shafts together, locked or with limited slip.
  std::vector<Coupled> coupled() const;

  /// Torque [N m] about each wheel's axis over the next step dt [s], 0 for wheels not on the line;
  /// `mass` is the machine's [kg], `pump_power` what its pump takes [W], which matters where both
  /// have one engine. The brake is on: all 0, and the governors start afresh from the present
  /// speed.
  void torques(const DriveInput& input, const std::vector<WheelTurn>& turns, double mass, double dt,
               std::vector<double>& torque, double pump_power = 0);
  /// After that: the mean of all driven wheels as a source of speed holds it; nothing otherwise.
  const std::optional<HeldCarrier>& held() const { return held_; }
  /// Tells the speed that it came to [rad/s] and the torque that it took [N m].
  void settle(double carrier, double torque);

  /// Zeros where neither gears nor a shared engine are.
  const CombustionEngineState& engine() const { return state_; }

  /// Memory of the governors and of the engine.
  void visit(Archive& a);

 protected:
  /// Wheels that one governor turns.
  struct Group {
    std::vector<char> members;  // is wheel w of machine.wheels one of them
    double share = 1;           // of the machine's mass, and of the motor's force and power
    SpeedGovernor governor;
  };
  DriveLine(const scene::Powertrain& powertrain, std::vector<Group> groups,
            const std::optional<scene::CombustionEngine>& engine = std::nullopt);
  static Group all_driven(const std::vector<DriveWheel>& wheels);
  /// Half the machine: the driven wheels of the left or right side.
  static Group driven_side(const std::vector<DriveWheel>& wheels, bool left);
  /// Speed that a group's wheels are to roll at [m/s].
  virtual double group_speed(const DriveInput& input, std::size_t group) const = 0;

 private:
  /// Those of a group that the line turns, together.
  static DrivenWheels on_line(const Group& group, const std::vector<WheelTurn>& turns, double mass);
  /// For each wheel of a group [N m], of the governed motor or of the engine.
  double motor_torque(Group& group, double speed, const DrivenWheels& wheels, double dt,
                      double pump_power);
  double engine_torque(Group& group, const DriveInput& input, const DrivenWheels& wheels, double dt,
                       double pump_power);

  scene::Powertrain powertrain_;
  std::vector<Group> groups_;
  std::optional<GearedEngine> engine_;  // of a line of one group
  std::optional<HeldCarrier> held_;     // of the present step
  CombustionEngineState state_;
};

/// The line of machine.drive.
std::unique_ptr<DriveLine> make_drive_line(const scene::Machine& machine);

/// The bicycle that follows the same arcs, for laws that steer by a bicycle angle whatever drives
/// the wheels: an Ackermann drive itself; for a differential drive one as long as its track, whose
/// tightest arc is the one on which the inner wheels stand still.
scene::AckermannDrive equivalent_bicycle(const scene::Drive& drive);
/// DriveInput::steer for an angle of that bicycle [rad] at `speed` [m/s, negative backwards].
double steer_command(const scene::Drive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
