// SPDX-License-Identifier: Apache-2.0
// A rigid wheel on soft ground by the plate and shear laws of terramechanics.
#pragma once

#include "scene/soil.h"

namespace navvy::lab {

/// A wheel that rolls along +x under a load, with a slip that is kept.
struct WheelCase {
  double radius = 0;  ///< [m]
  double width = 0;   ///< [m]
  double load = 0;    ///< [N]
  double slip = 0;    ///< 1 - v / (omega r) driven (>= 0), omega r / v - 1 braked (< 0, locked: -1)
};
struct WheelForce {
  double sinkage = 0;   ///< of the lowest point [m]
  double drawbar = 0;   ///< pull of the soil on the wheel along its way, negative: it must be towed [N]
  double torque = 0;    ///< that drives the wheel [N m]
  bool carried = true;  ///< false: the ground does not carry the load with the axle above it
};

/// Pressure p = (kc / b + kphi) z^n [Bekker 1969] and shear tau = (c + p tan phi) (1 - exp(-j / K)) [Janosi 1961], j
/// the way of the rim against the soil, summed over the arc in contact, which ends below the axle, where
/// the pressure is largest. Where it is let be largest farther ahead [Wong 1967] a wheel
/// sinks deeper: 32 mm for a case that gives 25 mm here [docs/validation.md, Wheels]. Friction on the rim is the lesser
/// of the soil's and the tool's; the soil's residual cohesion is left out beside it when the tool's is the lesser.
WheelForce rigid_wheel(const WheelCase& wheel, const scene::Soil& soil);

/// Speed of the rim [m/s] of a wheel that goes at `speed` with this slip.
double rim_speed(double speed, double slip);

}  // namespace navvy::lab
