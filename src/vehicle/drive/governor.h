// SPDX-License-Identifier: Apache-2.0
// Speed governor of a hydrostatic drive. Independent of the engine and the kind of drive.
#pragma once

#include <limits>

#include "core/archive.h"
#include "scene/drive.h"

namespace navvy::vehicle {

/// Wheels that one motor turns together: all driven wheels of an axle differential, or those of one
/// side.
struct DrivenWheels {
  int count = 0;
  /// Mean spin, that of the differential carrier [rad/s].
  double spin = 0;
  /// Mean loaded radius [m].
  double radius = 0;
  /// Inertia of all wheels together about their axes [kg m2].
  double spin_inertia = 0;
  /// Mass that they move [kg].
  double mass = 0;
  /// Response time of the governor to a speed error [s].
  double response = 0.3;
};

/// Computes the torque with which the mean speed of the driven wheels follows the speed asked for.
///
/// An open differential gives each wheel the same torque; its carrier turns with their mean. The
/// force at the ground is limited by the tractive force and by power / speed. The speed asked for
/// changes by at most 1.5 m/s2. The law is a feed-forward of the mass's acceleration, a
/// proportional part, and an integral that only grows while it can act.
class SpeedGovernor {
 public:
  /// Returns the torque for each of the wheels [N m] over the next step dt [s], towards `speed`
  /// [m/s]; 0 without wheels. At most `left` [W] of its power drives; braking uses the motor alone.
  double wheel_torque(const scene::Powertrain& powertrain, double speed, const DrivenWheels& wheels,
                      double dt, double left = std::numeric_limits<double>::infinity());

  /// Computes the same in two steps, for callers that limit the force otherwise: first the force
  /// asked for [N at the rims], then the part of it that is available, from `low` to `high` [N].
  double ask(double speed, const DrivenWheels& wheels, double dt);
  double give(double force, double low, double high, const DrivenWheels& wheels, double dt);
  /// Returns the speed after the ramp [m/s].
  double asked() const { return asked_; }
  /// Restarts the governor from this speed [m/s], while the brakes are on.
  void reset(double speed);

  /// Visits the ramp and the integral.
  void visit(Archive& a);

 private:
  double asked_ = 0;     // [m/s] after the ramp
  double integral_ = 0;  // [N]
};

}  // namespace navvy::vehicle
