// SPDX-License-Identifier: Apache-2.0
// The speed governor of a hydrostatic drive. Knows no engine and no kind of drive.
#pragma once

#include <limits>

#include "core/archive.h"
#include "scene/drive.h"

namespace navvy::vehicle {

/// Wheels that one motor turns together: all driven wheels of an axle differential, or those of one
/// side.
struct DrivenWheels {
  int count = 0;
  double spin = 0;          ///< mean of the wheels, that of the differential's cage [rad/s]
  double radius = 0;        ///< mean, loaded [m]
  double spin_inertia = 0;  ///< of all together about their axes [kg m2]
  double mass = 0;          ///< that they have to move [kg]
  double response = 0.3;    ///< of the governor to an error of speed [s]
};

/// Torque so that the driven wheels' mean speed follows the one asked for.
///
/// An open differential gives each wheel the same torque; its cage turns with their mean. The force
/// at the ground is limited by the tractive force and by power / speed; the asked speed changes by
/// at most 1.5 m/s2. Feed-forward of the mass's acceleration, a proportional part and an integral
/// that only grows while it can act.
class SpeedGovernor {
 public:
  /// Torque for each of the wheels [N m] over the next step dt [s], towards `speed` [m/s]; 0
  /// without wheels. Of its power no more than `left` [W] drives; holding back is the motor's own.
  double wheel_torque(const scene::Powertrain& powertrain, double speed, const DrivenWheels& wheels,
                      double dt, double left = std::numeric_limits<double>::infinity());

  /// The same in two steps, for whoever bounds the force otherwise: first what is asked for
  /// [N at the rims], then what of it there is, from `low` to `high` [N].
  double ask(double speed, const DrivenWheels& wheels, double dt);
  double give(double force, double low, double high, const DrivenWheels& wheels, double dt);
  /// The speed after the ramp [m/s].
  double asked() const { return asked_; }
  /// Brakes are on at this speed [m/s]: the governor starts afresh from it.
  void reset(double speed);

  void visit(Archive& a);

 private:
  double asked_ = 0;     // [m/s] after the ramp
  double integral_ = 0;  // [N]
};

}  // namespace navvy::vehicle
