// SPDX-License-Identifier: Apache-2.0
// Rigid wheel on soft ground by the plate and shear laws, integrated over the contact arc.
#pragma once

#include "scene/soil.h"

namespace navvy::terramechanics {

/// Wheel that rolls along +x under a load with a prescribed slip.
struct WheelCase {
  /// Radius r [m].
  double radius = 0;
  /// Width b [m].
  double width = 0;
  /// Load W [N].
  double load = 0;
  /// Slip: 1 - v / (omega r) driven (>= 0), omega r / v - 1 braked (< 0, locked: -1).
  double slip = 0;
  /// Angle between the direction of travel and the wheel's plane, below 90 degrees [rad].
  double slip_angle = 0;
  /// Height of the grousers on the rim [m]; 0: smooth.
  double grouser = 0;
  /// Coefficient of slip_sinkage() [-]; 0: slip does not increase the sinkage.
  double slip_sinkage = 0;
};

/// Force of the ground on the wheel when it carries the load.
struct WheelForce {
  /// Sinkage of the lowest point [m].
  double sinkage = 0;
  /// Pull of the soil on the wheel along its travel [N]; negative: the wheel must be towed.
  double drawbar = 0;
  /// Resistance of the soil pushed ahead, part of the drawbar pull [N].
  double bulldozing = 0;
  /// Driving torque [N m].
  double torque = 0;
  /// Force of the soil on the wheel against its lateral motion [N].
  double side = 0;
  /// False if the ground cannot carry the load with the axle above it.
  bool carried = true;
};

/// Computes the force on a wheel with the plate's pressure [Bekker 1969] and the shear of
/// [Janosi 1961] over the arc from the entry angle theta_1 to below the axle, where the pressure is
/// largest:
///
///   W = b r int (p cos + tau sin) dtheta,   pull = b r int (tau cos - p sin) dtheta
///   T = b r2 int tau dtheta
///
/// p is taken at the depth r (cos theta - cos theta_1), tau at the displacement of the rim over the
/// soil since it entered, j = r ((theta_1 - theta) - (1 - s) (sin theta_1 - sin theta))
/// [Wong 2008, section 2.5]. [Wong 1967] places the largest pressure farther ahead; a wheel then
/// sinks deeper (32 mm in a published case that gives 25 mm here).
///
/// Laterally the rim moves by j_y = r (theta_1 - theta) (1 - s) tan beta with the slip angle beta,
/// and shear acts against both displacements together. Soil that piles up at the wheel's side is
/// neglected. Slip lowers the modulus such that a smooth wheel sinks slip_sinkage() times as deep:
/// by its power n + 1/2 [Bekker 1956]. Bulldozing (bearing.h) adds a resistance at the axle. A
/// smooth rim has rim_strength(soil); between grousers soil slides on soil (surface_strength at
/// bank density) at r plus their height. The load grows with theta_1, which is found by bisection.
WheelForce rigid_wheel(const WheelCase& wheel, const scene::Soil& soil);

/// Returns the rim speed [m/s] of a wheel that travels at `speed` [m/s] with this slip [-], see
/// WheelCase::slip.
double rim_speed(double speed, double slip);

}  // namespace navvy::terramechanics
