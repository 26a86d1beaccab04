// SPDX-License-Identifier: Apache-2.0
// Combustion engine with gears and automatic gear selection. Independent of the type of drive.
//
//   w = i g u,   M = i g eta T     while the engine drives
//                M = i g T / eta   while the machine turns the engine
//
// u is the speed [rad/s] and M the torque [N m] of the differential carrier, w and T are those of
// the engine, g is the gear ratio, i the final drive ratio, and eta the efficiency of both
// together.
#pragma once

#include "scene/drive.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// Combustion engine with gears. Computes the engine's torque at the differential carrier and
/// selects the gear.
///
/// An engine with a torque curve never turns slower than at idle, or, if it also drives a pump,
/// never slower than at its maximum power. Below that speed, a clutch slips and transmits the
/// torque that the engine has at that speed. Above the governed speed the engine gives no torque.
/// Without fuel it brakes with its braking torque, which rises from 0 at idle to its full value at
/// 1.25 times idle speed. Shifting takes no time, and the engine has no inertia of its own.
///
/// All speeds and torques are positive in the commanded direction of travel: a reverser between
/// engine and carrier changes the sign for travel backwards.
class GearedEngine {
 public:
  /// Makes an engine with the properties `about`. `drives_pump` is true if the engine also drives
  /// the machine's pump.
  /// @throws InputError without gears, or for a torque curve with less than two points.
  GearedEngine(scene::CombustionEngine about, bool drives_pump);

  /// Returns the properties of this engine as given in the scene.
  const scene::CombustionEngine& about() const { return about_; }
  /// Returns the overall ratio [-], engine speed divided by carrier speed, in `gear` (1-based).
  double ratio(int gear) const;
  /// Returns the overall ratio [-] in the engaged gear.
  double ratio() const { return ratio(gear_); }
  /// Returns the largest speed of the carrier [rad/s] in the commanded gear, or in any gear if
  /// `command` is 0.
  double fastest(int command) const;

  /// Engages the gear for the next step of `dt` [s]: the gear `command` (1-based), or an
  /// automatically selected gear if `command` is 0.
  ///
  /// Automatic selection takes the highest gear that gives the carrier torque `torque` [N m] at the
  /// carrier speed `carrier` [rad/s], or the strongest gear if none does. Shifting up requires 1.25
  /// times that torque, or 1.25 times what the engaged gear gives, whichever is less. It changes
  /// gears at most once per second, unless the engine would leave its speed range. A speed source
  /// uses first gear unless another gear is commanded.
  void shift(int command, double carrier, double torque, double dt);
  /// Range of torques that the engine can give at the carrier.
  struct Bounds {
    /// Most negative (braking) and largest (driving) torque at the carrier [N m].
    double low = 0, high = 0;
  };
  /// Returns the range of torques in the engaged gear at the speed `carrier` [rad/s]. The pump has
  /// priority: it takes `pump_power` [W] first.
  Bounds bounds(double carrier, double pump_power) const;
  /// Returns the engine's state for the carrier's speed `carrier` [rad/s] and `torque` [N m] while
  /// the pump takes `pump_power` [W]. Torque and power include pump and drive.
  CombustionEngineState state(double carrier, double torque, double pump_power) const;

  /// Saves, loads or hashes the engaged gear and the time since the last gear change.
  void visit(Archive& a);

 private:
  /// Returns the number of gears.
  int count() const { return static_cast<int>(about_.gears.size()); }
  /// Returns the torque at full throttle [N m] at the engine speed `speed` [rad/s].
  double full_torque(double speed) const;
  /// Returns the braking torque without fuel [N m] at the speed `shaft` [rad/s].
  double drag(double shaft) const;
  /// Returns the engine's speed [rad/s] while the driven side of its clutch turns at `shaft`
  /// [rad/s]. It is larger than `shaft` while the clutch slips.
  double engine_speed(double shaft) const;
  /// Returns the largest driving torque at the carrier [N m] in `gear` at the carrier's speed
  /// [rad/s].
  double pull(int gear, double carrier) const;
  /// Returns the largest braking torque at the carrier [N m] in `gear` at the carrier's speed
  /// [rad/s], as a magnitude.
  double hold(int gear, double carrier) const;
  /// Returns true if the engine stays within its speed range in `gear` at the carrier's speed
  /// [rad/s]. The first gear has no lower limit, since its clutch may slip, and the last gear has
  /// no upper limit.
  bool fits(int gear, double carrier) const;

  /// Properties of the engine as given in the scene.
  scene::CombustionEngine about_;
  /// Smallest speed of an engine with a torque curve [rad/s].
  double slowest_ = 0;
  /// Engaged gear, 1-based.
  int gear_ = 1;
  /// Time since the last gear change [s], up to the shortest time between two changes.
  double held_;
};

}  // namespace navvy::vehicle
