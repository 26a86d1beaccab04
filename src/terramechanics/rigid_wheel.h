// SPDX-License-Identifier: Apache-2.0
// A rigid wheel on soft ground by the plate and shear laws: closed in its physics, summed over the
// arc in contact.
#pragma once

#include "scene/soil.h"

namespace navvy::terramechanics {

/// A wheel that rolls along +x under a load, with a slip that is kept.
struct WheelCase {
  double radius = 0;  ///< r [m]
  double width = 0;   ///< b [m]
  double load = 0;    ///< W [N]
  /// 1 - v / (omega r) driven (>= 0), omega r / v - 1 braked (< 0, locked: -1).
  double slip = 0;
  double slip_angle = 0;    ///< between its way and its plane, below 90 degrees [rad]
  double grouser = 0;       ///< height of the bars on its rim, 0: smooth [m]
  double slip_sinkage = 0;  ///< coefficient of slip_sinkage() [-]; 0: slip sinks it no deeper
};

/// What the ground does to it when the load is carried.
struct WheelForce {
  double sinkage = 0;  ///< of the lowest point [m]
  /// Pull of the soil on the wheel along its way, negative: it must be towed [N].
  double drawbar = 0;
  /// Resistance of the soil that it pushes ahead, counted in the drawbar [N].
  double bulldozing = 0;
  double torque = 0;    ///< that drives the wheel [N m]
  double side = 0;      ///< of the soil on the wheel against its sideways way [N]
  bool carried = true;  ///< false: the ground does not carry the load with the axle above it
};

/// Sums the plate's pressure [Bekker 1969] and the shear of [Janosi 1961] over the arc from the
/// entry angle theta_1 to below the axle, where the pressure is largest:
///
///   W = b r int (p cos + tau sin) dtheta,   pull = b r int (tau cos - p sin) dtheta,   T = b r2
///   int tau dtheta
///
/// with p at the depth r (cos theta - cos theta_1) and tau after the rim's way against the soil
/// since it entered, j = r ((theta_1 - theta) - (1 - s) (sin theta_1 - sin theta))
/// [Wong 2008, section 2.5]. [Wong 1967] lets the pressure be largest farther ahead; a wheel then
/// sinks deeper (32 mm in a published case that gives 25 mm here). Sideways the rim goes by j_y = r
/// (theta_1 - theta) (1 - s) tan beta with the slip angle beta, and shear acts against both ways
/// together; what piles up at the wheel's side is not counted. The modulus falls by slip such that
/// a smooth wheel sinks slip_sinkage() times as deep: by its power n + 1/2 [Bekker 1956]. What the
/// rim pushes ahead of it resists besides (bulldozing, bearing.h), through the axle. A smooth rim's
/// strength is rim_strength(soil); between grousers soil slides on soil (surface_strength at bank
/// density) at r plus their height. The load grows with theta_1, which is found by bisection.
WheelForce rigid_wheel(const WheelCase& wheel, const scene::Soil& soil);

/// Speed of the rim [m/s] of a wheel that goes at `speed` [m/s] with this slip [-]; see
/// WheelCase::slip.
double rim_speed(double speed, double slip);

}  // namespace navvy::terramechanics
