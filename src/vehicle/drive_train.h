// SPDX-License-Identifier: Apache-2.0
// Ackermann steering and a hydrostatic drive with open differential. Knows no engine.
#pragma once

#include "core/hash.h"
#include "core/state_io.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Angles of the left and right steered wheel [rad] for a bicycle angle at the middle of the front axle:
/// tan(inner) = L / (R - W/2), tan(outer) = L / (R + W/2), R = L / tan(bicycle) at the rear axle. The bicycle angle is
/// cut so that the inner wheel keeps within `drive.max_steer`.
struct SteerAngles {
  double left = 0, right = 0;
};
SteerAngles ackermann(const scene::Drive& drive, double bicycle);
/// Largest bicycle angle [rad].
double max_bicycle_angle(const scene::Drive& drive);

/// Speed governor of the drive: torque on the differential's cage so that the driven wheels' mean speed follows.
///
/// An open differential gives both wheels half the cage torque; the cage turns with their mean. Torque is limited by
/// the tractive force and by power / speed; the asked speed changes by at most 1.5 m/s2.
class DriveTrain {
 public:
  /// Torque for each of `wheels` driven wheels [N m] at mean spin `cage` [rad/s]; mass: of the machine [kg], spin
  /// inertia: of all driven wheels [kg m2].
  double wheel_torque(const scene::Drive& drive, double speed, double cage, double radius, int wheels, double mass,
                      double spin_inertia, double dt);
  /// Brakes are on: the governor starts afresh.
  void reset(double cage_speed);

  void hash(StateHash& hash) const;
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  double asked_ = 0;     // [m/s] after the ramp
  double integral_ = 0;  // [N]
};

}  // namespace navvy::vehicle
