// SPDX-License-Identifier: Apache-2.0
// Drive lines compute the effect of a drive command on every wheel of a machine. There is one class
// per type of drive, which all physics engines use.
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

/// Constant properties of one wheel of a machine, as a drive line needs them.
struct DriveWheel {
  /// True if the drive turns this wheel.
  bool driven = false;
  /// True for a wheel on the left side of the machine, whose link has y > 0 in the machine frame.
  bool left = false;
  /// Radius of the unloaded wheel [m].
  double radius = 0;
  /// Position of the wheel's link along x of the machine frame [m]. All wheels of one axle have the
  /// same value.
  double x = 0;
};
/// Returns the constant properties of all wheels, in the order of machine.wheels.
std::vector<DriveWheel> drive_wheels(const scene::Machine& machine);

/// Differential of a drive line between two groups of wheels.
///
/// The differential's carrier turns with half the sum of |weight| x spin over all wheels. Its
/// torque is the sum of the torques of its shafts.
struct Coupled {
  /// Name of the differential: axle_1 for the foremost driven axle, axle_2 for the next one and so
  /// on, and centre for the one between axles.
  std::string name;
  /// Type and locking properties of the differential as given in the scene.
  scene::Differential about;
  /// Weight of each wheel of the machine [-]: positive on one side of the differential, negative on
  /// the other, 0 for wheels without a shaft to it. The speed difference of the two shafts is the
  /// sum of weight x spin.
  std::vector<double> weight;
};

/// Differential carrier whose speed over the next step is prescribed by an engine that acts as a
/// speed source.
struct HeldCarrier {
  /// Prescribed speed of the carrier [rad/s].
  double speed = 0;
  /// Largest torque that may be used to reach the prescribed speed [N m].
  double torque = 0;
};

/// Rotation of one wheel at the start of a step.
struct WheelTurn {
  /// True if the drive currently turns this wheel: the wheel is driven, and no joint command has
  /// overridden the drive.
  bool on_line = false;
  /// Angular speed of the wheel [rad/s]; positive rolls forward.
  double spin = 0;
  /// Radius of the wheel under load [m].
  double radius = 0;
  /// Inertia of the wheel about its axis [kg m2].
  double spin_inertia = 0;
  /// True if the wheel is the sprocket of a crawler's track.
  bool running_track = false;
};

/// Spin and steering angle of one wheel, from which engines without forces compute the machine's
/// motion.
struct WheelMotion {
  /// Angular speed of the wheel [rad/s]; positive rolls forward.
  double spin = 0;
  /// Position of the wheel's steering joint [rad]; nothing if it has no steering joint.
  std::optional<double> steer;
};

/// Motion of the machine frame when its wheels roll without slip.
struct Roll {
  /// Speed along x of the machine frame [m/s].
  double speed = 0;
  /// Yaw rate [rad/s], positive to the left.
  double yaw_rate = 0;
};

/// Drive line of one machine: converts drive commands to wheel speeds, steering angles and torques.
///
/// Speeds and steering angles (roll(), rolling_spin(), steer_angle()) depend only on the command.
/// An engine without forces moves the machine by them; an engine with forces turns the steering
/// joints by them. Torques also depend on the state of the governors, which is saved and hashed.
class DriveLine {
 public:
  /// Destroys the drive line.
  virtual ~DriveLine() = default;

  /// Returns the motion of the machine for a command, within the limits of speed and steering; zero
  /// under the brake. For a drive that steers by an angle, the yaw rate is speed x curvature.
  virtual Roll roll(const DriveInput& input) const = 0;
  /// Returns the motion of the machine for the current motion of its wheels. `motion` has one entry
  /// per wheel of the machine. The driven wheels (of each side, if the sides are driven separately)
  /// roll without slip on average; other wheels slip if necessary.
  virtual Roll rolled(const std::vector<WheelMotion>& motion) const = 0;
  /// Returns the spin [rad/s] of a wheel that rolls without slip while the machine moves by `roll`.
  virtual double rolling_spin(const Roll& roll, const DriveWheel& wheel) const = 0;
  /// Returns the angle [rad] of a wheel's steering joint for a command; nothing for a drive that
  /// does not steer wheels.
  virtual std::optional<double> steer_angle(const DriveInput& input,
                                            const DriveWheel& wheel) const = 0;
  /// Returns the largest speed of a steering joint [rad/s].
  virtual double steer_rate() const = 0;

  /// Returns the steering error [rad] while the left and right steered wheels are at the angles
  /// `left` and `right` [rad]: how much further the outer wheel is turned than rolling about a
  /// common centre requires. Returns nothing for a drive without a tie rod.
  virtual std::optional<double> steering_error(double left, double right) const {
    (void)left, (void)right;
    return std::nullopt;
  }
  /// Returns true if one motor turns the wheels through shafts, false if each wheel has its own
  /// motor.
  virtual bool has_shafts() const { return true; }
  /// Returns all differentials of the drive line; empty for a type of drive without differentials.
  virtual std::vector<Coupled> differentials() const { return {}; }
  /// Returns the differentials that couple their shafts, which are locked or have limited slip.
  /// Open differentials are left out.
  std::vector<Coupled> coupled() const;

  /// Computes the torque [N m] about each wheel's axis over the next step `dt` [s] into `torque`,
  /// one entry per wheel; 0 for wheels that the drive does not turn.
  ///
  /// `turns` has one entry per wheel of the machine. `mass` is the machine's mass [kg].
  /// `pump_power` [W] is the power that the machine's pump takes, which matters only if drive and
  /// pump share one engine. Under the brake all torques are 0, and the governors restart from the
  /// current speed.
  void torques(const DriveInput& input, const std::vector<WheelTurn>& turns, double mass, double dt,
               std::vector<double>& torque, double pump_power = 0);
  /// Returns the mean speed of all driven wheels that an engine of type speed source prescribes for
  /// this step; nothing for other engines. Call it after torques().
  const std::optional<HeldCarrier>& held() const { return held_; }
  /// Records the speed [rad/s] that the carrier of a speed source reached in the step, and the
  /// torque [N m] that it took.
  void settle(double carrier, double torque);

  /// Returns the state of the combustion engine after the last step; all zero for a drive that has
  /// no gears and does not share its engine with the pump.
  const CombustionEngineState& engine() const { return state_; }

  /// Saves, loads or hashes the state of all governors and of the engine.
  void visit(Archive& a);

 protected:
  /// Wheels that are turned together by one governor.
  struct Group {
    /// One entry per wheel of machine.wheels; nonzero if the wheel belongs to the group.
    std::vector<char> members;
    /// Group's share of the machine's mass and of the motor's force and power [-].
    double share = 1;
    /// True if the wheels skid sideways in a turn, so that the governor must be as stiff as that of
    /// a track.
    bool skids = false;
    /// Governor that turns the group's wheels.
    SpeedGovernor governor;
  };
  /// Makes a drive line of these groups of wheels. An `engine` with gears requires exactly one
  /// group; without it, each group is turned by a governed motor.
  DriveLine(const scene::Powertrain& powertrain, std::vector<Group> groups,
            const std::optional<scene::CombustionEngine>& engine = std::nullopt);
  /// Returns the group of all driven wheels.
  static Group all_driven(const std::vector<DriveWheel>& wheels);
  /// Returns the group of the driven wheels on the left or right side, with half the machine's
  /// mass, force and power.
  static Group driven_side(const std::vector<DriveWheel>& wheels, bool left);
  /// Returns the commanded speed [m/s] of the wheels' rims for the group with index `group`.
  virtual double group_speed(const DriveInput& input, std::size_t group) const = 0;

 private:
  /// Returns the combined properties of those wheels of a group that the drive currently turns.
  static DrivenWheels on_line(const Group& group, const std::vector<WheelTurn>& turns, double mass);
  /// Returns the torque [N m] on each wheel of a group that a governed motor turns. `speed` is the
  /// commanded rim speed [m/s].
  double motor_torque(Group& group, double speed, const DrivenWheels& wheels, double dt,
                      double pump_power);
  /// Returns the torque [N m] on each wheel of the group that an engine with gears turns; 0 for a
  /// speed source, which prescribes `held_` instead.
  double engine_torque(Group& group, const DriveInput& input, const DrivenWheels& wheels, double dt,
                       double pump_power);

  /// Limits of motor and brakes as given in the scene.
  scene::Powertrain powertrain_;
  /// Groups of wheels, each with its own governor.
  std::vector<Group> groups_;
  /// Engine with gears of a drive line with one group; empty for governed motors.
  std::optional<GearedEngine> engine_;
  /// Carrier speed that a speed source prescribes for the current step.
  std::optional<HeldCarrier> held_;
  /// State of the combustion engine after the last step.
  CombustionEngineState state_;
};

/// Makes the drive line for the type of machine.drive.
std::unique_ptr<DriveLine> make_drive_line(const scene::Machine& machine);

/// Returns a single-track (bicycle) model that can follow the same arcs as `drive`. Path followers
/// use it to steer any machine by a bicycle angle.
///
/// For an Ackermann drive or a steering linkage it is the drive itself. For a differential drive,
/// the model's wheelbase is the track width, and its largest angle is that of the arc on which the
/// inner wheels stand still.
scene::AckermannDrive equivalent_bicycle(const scene::Drive& drive);
/// Returns the value of DriveInput::steer with which `drive` follows the same arc as its
/// equivalent_bicycle() at the steering angle `bicycle` [rad] and the speed `speed` [m/s] (negative
/// backwards).
double steer_command(const scene::Drive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
