// SPDX-License-Identifier: Apache-2.0
// An engine, the gears behind it and who chooses among them. Knows no kind of drive.
//
//   w = i g u,   M = i g eta T     while it drives     (M = i g T / eta while it is dragged)
//
// u speed [rad/s] and M torque [N m] of the differential's cage, w and T those of the engine, g
// ratio of the gear, i of the final drive, eta their efficiency.
#pragma once

#include "scene/drive.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// What an engine with gears can do to the cage of a differential, and which gear is in.
///
/// An engine with a torque curve never turns slower than at idle, one that shares its power with a
/// pump never slower than where its power is largest: below, a clutch slips and passes the torque
/// of that speed. Above the governed speed it gives none. Without fuel it brakes with its braking
/// torque, which fades in from idle to 1.25 times idle. Shifting takes no time and the engine has
/// no inertia of its own.
///
/// All values count in the way the machine is asked to go: a reverser turns the whole line round.
class GearedEngine {
 public:
  /// @throws InputError without gears, or without two points of a torque curve.
  GearedEngine(scene::CombustionEngine about, bool drives_pump);

  const scene::CombustionEngine& about() const { return about_; }
  /// Of engine to cage, in a gear from 1 on, or in the one that is in.
  double ratio(int gear) const;
  double ratio() const { return ratio(gear_); }
  /// Speed of the cage [rad/s] that no gear which `command` allows goes beyond.
  double fastest(int command) const;

  /// Puts in the gear `command` for the next step; 0 chooses: the highest one that gives `torque`
  /// [N m] at the cage's speed `cage` [rad/s], or where none does, the strongest; for a change
  /// upwards a quarter more than it, or than what the gear that is in gives. It changes once a
  /// second at most unless the engine would leave its range. A source of speed stays in the first.
  void shift(int command, double carrier, double torque, double dt);
  /// Torque of the cage [N m] that is to be had at its speed while a pump takes `pump_power` [W],
  /// which goes first.
  struct Bounds {
    double low = 0, high = 0;
  };
  Bounds bounds(double carrier, double pump_power) const;
  /// What the engine does at these; its power is the pump's and the drive's together.
  CombustionEngineState state(double carrier, double torque, double pump_power) const;

  /// The gear, and when it was put in.
  void visit(Archive& a);

 private:
  int count() const { return static_cast<int>(about_.gears.size()); }
  double full_torque(double speed) const;
  double drag(double shaft) const;
  /// Speed of the engine [rad/s] for that of its clutch's other side.
  double engine_speed(double shaft) const;
  /// Most torque at the cage [N m] in a gear: forwards, and holding back.
  double pull(int gear, double carrier) const;
  double hold(int gear, double carrier) const;
  /// In a gear the engine would neither slip nor race at this speed of the cage.
  bool fits(int gear, double carrier) const;

  scene::CombustionEngine about_;
  double slowest_ = 0;  // [rad/s]
  int gear_ = 1;
  double held_;  // since the last change [s]
};

}  // namespace navvy::vehicle
