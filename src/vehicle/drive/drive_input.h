// SPDX-License-Identifier: Apache-2.0
// Command of a drive, which has the same form for all types of drive and all physics engines.
#pragma once

#include "core/archive.h"

namespace navvy::vehicle {

/// Command of a machine's drive, which holds until it is replaced.
struct DriveInput {
  /// Speed of the machine [m/s]; positive forward.
  double speed = 0;
  /// Steering command, positive to the left. Its meaning depends on the type of drive: bicycle
  /// angle [rad] for Ackermann steering, position of the steering motor [rad] for a steering
  /// linkage, yaw rate [rad/s] for a differential drive. See scene::steer_unit and
  /// scene::steer_meaning.
  double steer = 0;
  /// True to stop the machine with its brakes. Steered wheels still follow `steer`; the other
  /// values have no effect. The brake also locks oscillating axles and casters, which swing freely
  /// without it.
  bool brake = true;
  /// Gear of an engine with gears, 1-based; 0 to select gears automatically.
  int gear = 0;

  /// Saves, loads or hashes all values except the gear, which is part of the state of a drive with
  /// gears.
  void visit(Archive& a);
};

}  // namespace navvy::vehicle
