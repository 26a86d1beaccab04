// SPDX-License-Identifier: Apache-2.0
// Closed-form and published formulas that results of rigs are compared with. Each comment gives
// equation, symbols and source.
//
// All functions use SI units and angles in rad. Symbols: gamma = rho g is a unit weight [N/m3],
// c is a cohesion [Pa], pressures [Pa] are positive in compression, phi is the soil's friction
// angle in plane strain, and delta is the friction angle of soil on steel. Nothing here depends on
// the solver or its cells.
#pragma once

#include <functional>

namespace navvy::lab {

// Earth pressure on a smooth vertical wall of height H under level ground [Rankine 1857].

/// Returns the coefficient of active earth pressure, for a wall that moves away from the soil: Ka =
/// (1 - sin phi) / (1 + sin phi). `phi` is the soil's friction angle [rad].
double rankine_active(double phi);
/// Returns the coefficient of passive earth pressure, for a wall that is pushed into the soil: Kp =
/// (1 + sin phi) / (1 - sin phi). `phi` is the soil's friction angle [rad].
double rankine_passive(double phi);
/// Returns the active force per metre of wall [N/m] on a smooth vertical wall: Pa = gamma H^2 Ka /
/// 2 - 2 c H sqrt(Ka) + 2 c^2 / gamma. H is the height of the wall [m], gamma the unit weight
/// [N/m3], c the cohesion [Pa] and Ka = rankine_active(phi).
///
/// The soil carries no tension, so it exerts no pressure above the depth of the tension crack, 2 c
/// / (gamma sqrt(Ka)). For a wall that is lower than that depth, the result is 0.
double rankine_active_force(double phi, double cohesion, double unit_weight, double height);
/// Returns the passive force per metre of wall [N/m] on a smooth vertical wall: Pp = gamma H^2 Kp /
/// 2 + 2 c H sqrt(Kp). H is the height of the wall [m], gamma the unit weight [N/m3], c the
/// cohesion [Pa] and Kp = rankine_passive(phi).
double rankine_passive_force(double phi, double cohesion, double unit_weight, double height);

/// Input of the blade formulas: a flat blade that cuts level ground, and the soil.
struct BladeCase {
  /// Friction angle of the soil (phi) and of soil on the blade (delta) [rad].
  double phi = 0, delta = 0;
  /// Rake alpha, the angle between the blade's face and the ground ahead [rad]; pi/2 is upright.
  double rake = 0;
  /// Cutting depth d and blade width w [m].
  double depth = 0, width = 1;
  /// Unit weight gamma [N/m3], cohesion c of the soil [Pa], and adhesion ca of soil on the blade
  /// [Pa].
  double unit_weight = 0, cohesion = 0, adhesion = 0;
  /// Surcharge q, a uniform pressure on the ground ahead of the blade [Pa].
  double surcharge = 0;
};
/// Force of the soil on a blade; the symbols are those of BladeCase. A wedge of soil slides up
/// between the blade and a rupture plane that rises from the cutting edge at the angle beta. Each
/// formula below takes the beta that gives the smallest force.
///
/// P is the resultant on the blade without adhesion, inclined by delta to the blade's normal. The
/// components with adhesion are H = P sin(alpha + delta) + ca d w cot(alpha) along the ground and V
/// = P cos(alpha + delta) - ca d w, positive downwards.
struct BladeForce {
  /// Angle beta of the rupture plane with the ground [rad].
  double beta = 0;
  /// Resultant P without adhesion [N].
  double force = 0;
  /// Component H along the ground [N].
  double horizontal = 0;
  /// Component V, positive downwards [N].
  double vertical = 0;
};
/// Returns the force of a wedge with a planar rupture surface, an exact solution for such a wedge
/// [Reece 1964]. With the symbols of BladeCase and BladeForce: P = (gamma d^2 Ng + c d Nc + ca d Na
/// + q d Nq) w with D = cos(alpha + delta) + sin(alpha + delta) cot(beta + phi), Ng = (cot alpha +
/// cot beta) / (2 D), Nc = (1 + cot beta cot(beta + phi)) / D, Na = (1 - cot alpha cot(beta + phi))
/// / D, Nq = (cot alpha + cot beta) / D.
BladeForce reece_wedge(const BladeCase& blade);
/// Returns the force on a narrow blade, beside which crescents of soil fail as well [McKyes 1977]:
/// P as in reece_wedge with other factors. With the wedge's length r = d (cot alpha + cot beta) and
/// s = sqrt(1 - (cot alpha / (cot alpha + cot beta))^2): Ng = r / (2 d) (1 + 2 r s / (3 w)) / D, Nc
/// = (1 + cot beta cot(beta + phi)) (1 + r s / w) / D, Nq = r / d (1 + r s / w) / D. P contains no
/// adhesion term. For w >> d the result is that of the planar wedge.
BladeForce mckyes_ali(const BladeCase& blade);
/// Returns the force of dry sand on a blade whose face has the given `length` from edge to edge
/// [m]: an estimate of the peak force in plane strain, without inertia [Miedema 2014, chapter 5].
///
/// The cut layer has the thickness t = d sin(alpha + beta) / sin(beta). It slides up the whole
/// blade and rises above it by the cutting depth without support: P = gamma w t (length + d + d
/// cos(alpha + beta) / (2 sin beta)) sin(beta + phi) / sin(alpha + beta + delta + phi). At 0.05 m/s
/// the neglected inertia is 0.3 N. Cohesion, adhesion and surcharge must be 0.
BladeForce riding_layer(const BladeCase& blade, double length);
/// Returns the force of a wedge with a planar rupture surface under ground of any shape
/// [Coulomb 1776]: P = gamma w A sin(beta + phi) / sin(alpha + beta + delta + phi), where A is the
/// area between blade, rupture plane and ground surface.
///
/// `surface(x)` returns the height of the ground above the cutting edge at the distance x ahead
/// of the edge, and `height` is the height of the blade's upper edge above its cutting edge [m].
/// The rake must be at most pi/2; cohesion, adhesion and surcharge must be 0.
BladeForce wedge_under(const BladeCase& blade, double height,
                       const std::function<double(double)>& surface);

// Bearing capacity of a strip footing on weightless soil, associated flow: p = c Nc + q Nq.

/// Returns the bearing capacity factor of the surcharge for a strip footing on weightless soil
/// [Reissner 1924]: Nq = exp(pi tan phi) tan^2(45 deg + phi / 2). The bearing pressure is c Nc + q
/// Nq with the cohesion c and the surcharge q. `phi` is the soil's friction angle [rad].
double bearing_nq(double phi);
/// Returns the bearing capacity factor of the cohesion for a strip footing on weightless soil
/// [Prandtl 1920]: Nc = (Nq - 1) cot phi, with Nq = bearing_nq(phi), and pi + 2 at phi = 0. `phi`
/// is the soil's friction angle [rad].
double bearing_nc(double phi);
/// Returns the friction angle phi* [rad] that soil with the friction angle `phi` [rad] and zero
/// dilatancy mobilises in a rigid-plastic failure mechanism [Davis 1968]: tan phi* = sin phi.
double davis_angle(double phi);

// Height [m] of a vertical cut.

/// Returns the height at which a vertical cut fails along a slip circle [m] [Taylor 1948]: Hc =
/// 3.83 c / gamma tan(45 deg + phi / 2). c is the cohesion [Pa], gamma the unit weight [N/m3] and
/// phi the friction angle [rad].
double cut_critical_height(double phi, double cohesion, double unit_weight);
/// Returns the maximum height of a vertical cut that needs no tension anywhere in the soil [m]: 2 c
/// / gamma tan(45 deg + phi / 2) [Terzaghi 1943]. It equals the depth of the tension crack. c is
/// the cohesion [Pa], gamma the unit weight [N/m3] and phi the friction angle [rad].
double cut_no_tension_height(double phi, double cohesion, double unit_weight);

// Granular collapse of a column of height H0: a = H0 / L0 (plane, released on one side) or H0 / R0
// (axisymmetric). Run-out is (front - L0) / L0 with the front at rest; heights are those of the
// deposit. Fits to experiments, independent of the grains.

/// Returns the run-out of a plane column collapse as a fraction of the column's initial length L0,
/// (front - L0) / L0 [Lube 2005]. `a` = H0 / L0 is the aspect ratio of the column with the initial
/// height H0. The result is 1.2 a below a = 1.8, 1.9 a^(2/3) above a = 2.8, and linear between the
/// two.
double lube_plane_run_out(double a);
/// Returns the run-out of an axisymmetric column collapse as a fraction of the column's initial
/// radius R0, (front - R0) / R0 [Lube 2004]. `a` = H0 / R0 is the aspect ratio of the column with
/// the initial height H0. The result is 1.24 a below a = 1.7, and 1.6 a^(1/2) above.
double lube_axisymmetric_run_out(double a);
/// Returns the final height H of an axisymmetric column collapse as a fraction of the column's
/// initial radius R0 [Lajeunesse 2004]. `a` = H0 / R0 is the aspect ratio of the column with the
/// initial height H0. The result is a below a = 0.74, and 0.74 above.
double lajeunesse_axisymmetric_height(double a);
/// Returns the final height H of a plane column collapse as a fraction of the column's initial
/// length L0 [Lajeunesse 2005]. `a` = H0 / L0 is the aspect ratio of the column with the initial
/// height H0. The result is a below a = 0.7, and a^(1/3) above.
double lajeunesse_plane_height(double a);
/// Returns the final height H of a plane column collapse as a fraction of the column's initial
/// length L0 [Lube 2005]. `a` = H0 / L0 is the aspect ratio of the column with the initial height
/// H0. The result is a below a = 1.15, and a^(2/5) above.
double lube_plane_height(double a);

/// Returns the slope angle [rad] at which soil with the friction angle `phi` [rad] and zero
/// dilatancy flows: atan(sin phi). In the flow, stress and strain rate have the same principal
/// axes. The plane along the slope then carries at most the ratio sin phi of shear stress to normal
/// stress [Davis 1968].
double flow_angle(double phi);

}  // namespace navvy::lab
