// SPDX-License-Identifier: Apache-2.0
// Command of a drive, the same for every kind of drive and every engine.
#pragma once

#include "core/archive.h"

namespace navvy::vehicle {

/// Command of a drive; held until replaced. `steer` depends on the kind: a bicycle angle [rad] for
/// an Ackermann drive, a yaw rate [rad/s] for a differential drive, both positive to the left
/// (scene::steer_unit, scene::steer_meaning).
///
/// The brake also locks an oscillating axle or a caster; without it they swing freely.
struct DriveInput {
  double speed = 0;  ///< forward [m/s]
  double steer = 0;  ///< [rad] or [rad/s], by kind
  /// Stops the machine. Wheels that steer still follow `steer`; nothing else has an effect.
  bool brake = true;
  /// Gear of an engine with gears, 1-based; 0: automatic.
  int gear = 0;

  /// Visits all but the gear, which belongs to the state of a drive with gears.
  void visit(Archive& a);
};

}  // namespace navvy::vehicle
