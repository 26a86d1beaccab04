// SPDX-License-Identifier: Apache-2.0
// The command of a drive, the same for every kind and every engine.
#pragma once

#include "core/archive.h"

namespace navvy::vehicle {

/// Held until replaced. What `steer` means is the drive's: a bicycle angle [rad] of an Ackermann
/// drive, a yaw rate [rad/s] of a differential drive, both positive to the left (scene::steer_unit,
/// scene::steer_meaning).
///
/// The brake also locks an oscillating axle or a caster; without it they swing freely.
struct DriveInput {
  double speed = 0;  ///< forward [m/s]
  double steer = 0;  ///< [rad] or [rad/s], as said
  /// Hold the place; speed and steer of wheels that turn to steer aside, nothing else acts.
  bool brake = true;
  int gear = 0;  ///< of an engine with gears, from 1 on; 0: it chooses

  /// All but the gear, which only the state of a drive with gears holds.
  void visit(Archive& a);
};

}  // namespace navvy::vehicle
