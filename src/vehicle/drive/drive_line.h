// SPDX-License-Identifier: Apache-2.0
// Drive lines: the effect of a drive command on every wheel of a machine. One class per kind of
// drive, used by all engines.
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

/// Constant properties of a wheel in a drive line.
struct DriveWheel {
  bool driven = false;
  /// On the left side of the machine: its link has y > 0 in M.
  bool left = false;
  /// Unloaded radius [m].
  double radius = 0;
  /// Position of its link along x of M [m], equal for all wheels of an axle.
  double x = 0;
};
/// Returns one entry for each of machine.wheels.
std::vector<DriveWheel> drive_wheels(const scene::Machine& machine);

/// Differential of the line. Its carrier turns with half the sum of |weight| x spin, and its torque
/// is the sum of its shafts' torques.
struct Coupled {
  /// Name: axle_1 for the foremost driven axle and so on, centre between axles.
  std::string name;
  scene::Differential about;
  /// Weights by wheel [-]: the shafts' speed difference is the sum of weight x spin.
  std::vector<double> weight;
};

/// Carrier with a prescribed speed over the next step.
struct HeldCarrier {
  double speed = 0;  ///< [rad/s]
  /// Largest torque [N m].
  double torque = 0;
};

/// Rotation of a wheel at the start of a step.
struct WheelTurn {
  /// Driven, and commanded by the drive (no joint command has taken it over).
  bool on_line = false;
  /// Spin [rad/s]; positive rolls forward.
  double spin = 0;
  /// Loaded radius [m].
  double radius = 0;
  double spin_inertia = 0;  ///< [kg m2]
  /// The wheel is a track's sprocket.
  bool running_track = false;
};

/// Motion of a wheel, for engines that move the machine by it.
struct WheelMotion {
  /// Spin [rad/s]; positive rolls forward.
  double spin = 0;
  /// Angle of its steering joint [rad]; nothing if it has none.
  std::optional<double> steer;
};

/// Motion of the machine's frame without wheel slip.
struct Roll {
  /// Speed along x of M [m/s].
  double speed = 0;
  /// Yaw rate [rad/s], positive to the left.
  double yaw_rate = 0;
};

/// Drive line of one machine.
///
/// Kinematics (roll, rolling_spin, steer_angle) depends on the command alone: an engine without
/// forces moves by it, an engine with forces turns steered joints by it. Torques depend on the
/// state of the governors, which is saved and hashed.
class DriveLine {
 public:
  virtual ~DriveLine() = default;

  /// Returns the motion for a command, within the limits of speed and steering; zero under the
  /// brake. The yaw rate is speed x curvature for a kind that steers by an angle.
  virtual Roll roll(const DriveInput& input) const = 0;
  /// Returns the motion that follows from wheels with this spin and steering, `motion` by wheel.
  /// The mean of the driven wheels of a side, or of all, rolls without slip; the others follow.
  virtual Roll rolled(const std::vector<WheelMotion>& motion) const = 0;
  /// Returns the spin [rad/s] of a wheel that rolls along.
  virtual double rolling_spin(const Roll& roll, const DriveWheel& wheel) const = 0;
  /// Returns the angle [rad] of a wheel's steering joint; nothing for a kind that does not turn
  /// wheels.
  virtual std::optional<double> steer_angle(const DriveInput& input,
                                            const DriveWheel& wheel) const = 0;
  /// Returns the largest rate of a steering joint [rad/s].
  virtual double steer_rate() const = 0;

  /// Returns how much further the outer wheel is turned than a common centre asks for [rad], with
  /// the left and right steered wheels at these angles; nothing for a kind without tie rod.
  virtual std::optional<double> steering_error(double left, double right) const {
    (void)left, (void)right;
    return std::nullopt;
  }
  /// Returns whether one motor turns the wheels through shafts. False for motors in the wheels.
  virtual bool has_shafts() const { return true; }
  /// Returns the differentials of the line; empty for a kind without any.
  virtual std::vector<Coupled> differentials() const { return {}; }
  /// Returns the differentials that couple their shafts: locked or with limited slip.
  std::vector<Coupled> coupled() const;

  /// Computes the torque [N m] about each wheel's axis over the next step dt [s], 0 for wheels not
  /// on the line. `mass` is the machine's [kg]; `pump_power` is the power of its pump [W], which
  /// counts if both share one engine. Under the brake all torques are 0, and the governors restart
  /// from the present speed.
  void torques(const DriveInput& input, const std::vector<WheelTurn>& turns, double mass, double dt,
               std::vector<double>& torque, double pump_power = 0);
  /// Returns the mean speed of all driven wheels that a speed source prescribes; nothing for other
  /// engines. Call it after `torques`.
  const std::optional<HeldCarrier>& held() const { return held_; }
  /// Records the speed [rad/s] that the carrier reached and the torque [N m] that it took.
  void settle(double carrier, double torque);

  /// Returns the state of the engine; zeros without gears and without a shared engine.
  const CombustionEngineState& engine() const { return state_; }

  /// Visits the state of governors and engine.
  void visit(Archive& a);

 protected:
  /// Wheels that one governor turns.
  struct Group {
    // Membership by wheel of machine.wheels.
    std::vector<char> members;
    // Share of the machine's mass, and of the motor's force and power.
    double share = 1;
    SpeedGovernor governor;
  };
  /// Makes a line of these groups, with an engine for a line of one group.
  DriveLine(const scene::Powertrain& powertrain, std::vector<Group> groups,
            const std::optional<scene::CombustionEngine>& engine = std::nullopt);
  /// Returns the group of all driven wheels.
  static Group all_driven(const std::vector<DriveWheel>& wheels);
  /// Returns half the machine: the driven wheels of the left or right side.
  static Group driven_side(const std::vector<DriveWheel>& wheels, bool left);
  /// Returns the speed that a group's wheels shall roll at [m/s].
  virtual double group_speed(const DriveInput& input, std::size_t group) const = 0;

 private:
  /// Returns the wheels of a group that the line turns, taken together.
  static DrivenWheels on_line(const Group& group, const std::vector<WheelTurn>& turns, double mass);
  /// Returns the torque [N m] for each wheel of a group, from the governed motor or from the
  /// engine.
  double motor_torque(Group& group, double speed, const DrivenWheels& wheels, double dt,
                      double pump_power);
  double engine_torque(Group& group, const DriveInput& input, const DrivenWheels& wheels, double dt,
                       double pump_power);

  scene::Powertrain powertrain_;
  std::vector<Group> groups_;
  // Engine of a line with one group.
  std::optional<GearedEngine> engine_;
  // Prescribed speed of the present step.
  std::optional<HeldCarrier> held_;
  CombustionEngineState state_;
};

/// Makes the line of machine.drive.
std::unique_ptr<DriveLine> make_drive_line(const scene::Machine& machine);

/// Returns a bicycle that follows the same arcs, for laws that steer by a bicycle angle whatever
/// drives the wheels. For an Ackermann drive it is the drive itself; for a differential drive it is
/// as long as the track width, and on its tightest arc the inner wheels stand still.
scene::AckermannDrive equivalent_bicycle(const scene::Drive& drive);
/// Returns DriveInput::steer for an angle of that bicycle [rad] at `speed`
/// [m/s, negative backwards].
double steer_command(const scene::Drive& drive, double bicycle, double speed);

}  // namespace navvy::vehicle
