// SPDX-License-Identifier: Apache-2.0
// Combustion engine with gears and their automatic selection. Independent of the kind of drive.
//
//   w = i g u,   M = i g eta T     while it drives     (M = i g T / eta while it is dragged)
//
// u is the speed [rad/s] and M the torque [N m] of the differential carrier, w and T those of the
// engine, g the ratio of the gear, i of the final drive, eta their efficiency.
#pragma once

#include "scene/drive.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// Computes the torque of an engine with gears at the differential carrier, and selects the gear.
///
/// An engine with a torque curve never turns slower than idle. One that shares its power with a
/// pump never turns slower than at its largest power: below, a clutch slips and passes the torque
/// of that speed. Above the governed speed it gives no torque. Without fuel it brakes with its
/// braking torque, which rises from 0 at idle to its full value at 1.25 times idle. Shifting takes
/// no time and the engine has no inertia of its own.
///
/// All values count in the direction in which the machine is asked to move: a reverser turns the
/// whole line round.
class GearedEngine {
 public:
  /// Takes the engine's data.
  /// @throws InputError without gears, or without two points of a torque curve.
  GearedEngine(scene::CombustionEngine about, bool drives_pump);

  /// Returns the engine's data.
  const scene::CombustionEngine& about() const { return about_; }
  /// Returns the overall ratio from engine to differential carrier, for gear n (1-based) or for the
  /// engaged gear.
  double ratio(int gear) const;
  double ratio() const { return ratio(gear_); }
  /// Returns the largest speed of the carrier [rad/s] in the gears that `command` allows.
  double fastest(int command) const;

  /// Engages the gear `command` for the next step; 0 selects a gear. That is the highest one that
  /// gives `torque` [N m] at the speed `carrier` [rad/s], or the strongest if none does.
  /// Shifting up needs a reserve of a quarter over that torque or over the torque of the engaged
  /// gear. Gears change once per second at most, unless the engine would leave its range. A speed
  /// source stays in first gear.
  void shift(int command, double carrier, double torque, double dt);
  /// Range of the carrier's torque [N m] at its speed while a pump takes `pump_power` [W], which
  /// has priority.
  struct Bounds {
    double low = 0, high = 0;
  };
  Bounds bounds(double carrier, double pump_power) const;
  /// Returns the engine's state at this speed and torque of the carrier. Its power includes pump
  /// and drive.
  CombustionEngineState state(double carrier, double torque, double pump_power) const;

  /// Visits the engaged gear and the time since it was engaged.
  void visit(Archive& a);

 private:
  /// Returns the number of gears.
  int count() const { return static_cast<int>(about_.gears.size()); }
  /// Returns the torque at full throttle [N m] at an engine speed [rad/s].
  double full_torque(double speed) const;
  /// Returns the braking torque without fuel [N m] at a speed [rad/s].
  double drag(double shaft) const;
  /// Returns the engine's speed [rad/s] for the speed of the other side of its clutch.
  double engine_speed(double shaft) const;
  /// Returns the largest torque at the carrier [N m] in a gear: driving, and holding back.
  double pull(int gear, double carrier) const;
  double hold(int gear, double carrier) const;
  /// Returns whether the engine neither slips nor overspeeds in a gear at this carrier speed.
  bool fits(int gear, double carrier) const;

  scene::CombustionEngine about_;
  double slowest_ = 0;  // [rad/s]
  int gear_ = 1;
  double held_;  // since the last change [s]
};

}  // namespace navvy::vehicle
