// SPDX-License-Identifier: Apache-2.0
// Speed governor of a hydrostatic drive. Independent of the physics engine and of the type of
// drive.
#pragma once

#include <limits>

#include "core/archive.h"
#include "scene/drive.h"

namespace navvy::vehicle {

/// Combined properties of the wheels that one motor turns: all driven wheels, or those of one side
/// of the machine.
struct DrivenWheels {
  /// Number of wheels that the motor turns.
  int count = 0;
  /// Mean angular speed of the wheels [rad/s], which is the speed of the differential carrier.
  double spin = 0;
  /// Mean radius of the wheels under load [m].
  double radius = 0;
  /// Sum of the wheels' inertias about their axes [kg m2].
  double spin_inertia = 0;
  /// Mass that these wheels have to move [kg].
  double mass = 0;
  /// Response time of the governor to a speed error [s].
  double response = 0.3;
};

/// Governor that computes the wheel torque with which the mean speed of the driven wheels follows
/// the commanded speed.
///
/// An open differential gives each wheel the same torque, and its carrier turns with the mean of
/// the wheels. The force at the ground is limited by the tractive force and by power / speed. The
/// setpoint approaches the commanded speed by at most 1.5 m/s2. The control law is a feed-forward
/// of the mass's acceleration plus a proportional and an integral part; the integral grows only
/// while the force is not limited.
class SpeedGovernor {
 public:
  /// Returns the torque on each wheel [N m] over the next step `dt` [s] that brings the wheels to
  /// the rim speed `speed` [m/s]; 0 if there are no wheels.
  ///
  /// The limits of speed, force and power are those of `powertrain`. A driving force is further
  /// limited to the power `left` [W], which a shared engine has left for the drive; a braking force
  /// is not.
  double wheel_torque(const scene::Powertrain& powertrain, double speed, const DrivenWheels& wheels,
                      double dt, double left = std::numeric_limits<double>::infinity());

  /// Advances the setpoint towards `speed` [m/s] and returns the unlimited force at the rims [N].
  /// Together with give(), it replaces wheel_torque() for callers that limit the force in another
  /// way.
  double ask(double speed, const DrivenWheels& wheels, double dt);
  /// Returns `force` limited to the range `low` to `high` [N at the rims], and advances the
  /// integral part accordingly. Call it after ask() in the same step.
  double give(double force, double low, double high, const DrivenWheels& wheels, double dt);
  /// Returns the setpoint of the rim speed [m/s], which approaches the commanded speed at a limited
  /// rate.
  double asked() const { return asked_; }
  /// Restarts the governor from the rim speed `speed` [m/s] with a zero integral part. Call it
  /// while the brakes are on.
  void reset(double speed);

  /// Saves, loads or hashes the setpoint and the integral part.
  void visit(Archive& a);

 private:
  /// Setpoint of the rim speed [m/s].
  double asked_ = 0;
  /// Integral part of the force [N].
  double integral_ = 0;
};

}  // namespace navvy::vehicle
