// SPDX-License-Identifier: Apache-2.0
// Force of soft ground on a rigid wheel. The plate law (plate.h) and the shear law (shear.h) are
// integrated over the contact arc.
#pragma once

#include "scene/soil.h"

namespace navvy::terramechanics {

/// Rigid wheel that rolls along +x under a given load with a prescribed slip.
struct WheelCase {
  /// Radius r of the wheel [m].
  double radius = 0;
  /// Width b of the rim [m].
  double width = 0;
  /// Vertical load W on the wheel [N].
  double load = 0;
  /// Prescribed slip s [-]. A driven wheel has s = 1 - v / (omega r) >= 0. A braked wheel has s =
  /// omega r / v - 1 < 0, and -1 when locked. v is the travel speed, omega the wheel's spin.
  double slip = 0;
  /// Angle [rad] between the direction of travel and the wheel's plane; less than pi / 2.
  double slip_angle = 0;
  /// Height of the grousers on the rim [m]; 0 for a smooth rim.
  double grouser = 0;
  /// Coefficient of slip_sinkage() (plate.h) [-]; 0 if slip does not increase the sinkage.
  double slip_sinkage = 0;
};

/// Force of the ground on a rigid wheel that carries its load, and the resulting sinkage.
struct WheelForce {
  /// Depth of the wheel's lowest point below the undisturbed surface [m].
  double sinkage = 0;
  /// Net pull of the soil on the wheel along its direction of travel [N]. A wheel with a negative
  /// drawbar pull must be towed.
  double drawbar = 0;
  /// Resistance of the soil that is pushed ahead of the wheel [N]. `drawbar` already contains it.
  double bulldozing = 0;
  /// Torque at the axle that drives the wheel [N m]; negative for a braked wheel.
  double torque = 0;
  /// Lateral force of the soil on the wheel [N], positive against the lateral motion.
  double side = 0;
  /// Part of `side` on the wheel's side wall [N].
  double side_wall = 0;
  /// False if the ground cannot carry the load even with the axle at the level of the surface. The
  /// other values then belong to that deepest position.
  bool carried = true;
};

/// Returns the force of `soil` in bank state on `wheel`, and its sinkage.
///
/// The plate's pressure p [Bekker 1969] and the shear stress tau [Janosi 1961] act over the arc
/// from the entry angle theta_1 to the lowest point of the rim (theta = 0), where the pressure is
/// largest:
///
///   W = b r int (p cos + tau sin) dtheta,   pull = b r int (tau cos - p sin) dtheta
///   T = b r2 int tau dtheta
///
/// p is evaluated at the depth r (cos theta - cos theta_1). tau is evaluated at the displacement of
/// the rim relative to the soil since it entered, j = r ((theta_1 - theta) - (1 - s) (sin theta_1 -
/// sin theta)) [Wong 2008, section 2.5]. [Wong 1967] finds the largest pressure farther ahead,
/// which makes a wheel sink deeper (32 mm in a published case for which this function gives 25 mm).
///
/// Laterally, the rim moves by j_y = r (theta_1 - theta) (1 - s) tan beta with the slip angle beta;
/// the shear stress opposes the resultant of both displacements. The sunken segment of the side
/// wall meets passive resistance (bearing.h) along the chord L at the depth d(x) of the rim, as far
/// as the lateral displacement since the soil met it mobilises it [Janosi 1961]:
///
///   F_wall = int R(d) (1 - exp(-j / K)) dx,   j = (L / 2 - x) tan beta
///
/// R(d) is passive_resistance() per width. Soil that piles up beside the wheel is neglected.
///
/// Slip sinkage is modelled by a lower modulus: it is divided by slip_sinkage() to the power n +
/// 1/2, so that a smooth wheel sinks slip_sinkage() times as deep [Bekker 1956]. Bulldozing
/// (bearing.h) adds a resistance at the axle.
///
/// A smooth rim has the shear strength rim_strength(soil). With grousers, soil slides on soil
/// (surface_strength at bank density) at the radius r plus the height of the grousers.
///
/// The load that the arc carries grows with theta_1; bisection finds the theta_1 that carries W.
WheelForce rigid_wheel(const WheelCase& wheel, const scene::Soil& soil);

/// Returns the speed omega r of the rim [m/s] of a wheel that travels at `speed` [m/s] with `slip`
/// [-] as defined by WheelCase::slip. The slip must be less than 1.
double rim_speed(double speed, double slip);

}  // namespace navvy::terramechanics
