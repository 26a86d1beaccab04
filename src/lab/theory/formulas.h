// SPDX-License-Identifier: Apache-2.0
// Closed forms and published formulas that results of rigs are compared with, each with its
// equation, symbols and source.
//
// SI units, angles [rad], unit weights gamma = rho g [N/m3], cohesion c and pressures [Pa],
// compression positive. phi is the friction angle in plane strain, delta that of soil on steel.
// Nothing here depends on the solver or its cells.
#pragma once

#include <functional>

namespace navvy::lab {

// Earth pressure on a smooth vertical wall of height H under level ground [Rankine 1857].

/// Returns the active coefficient, for a wall that yields: Ka = (1 - sin phi) / (1 + sin phi).
double rankine_active(double phi);
/// Returns the passive coefficient, for a wall that is pushed in: Kp = 1 / Ka.
double rankine_passive(double phi);
/// Returns the active force per metre of wall [N/m]: Pa = gamma H^2 Ka / 2 - 2 c H sqrt(Ka) + 2 c^2
/// / gamma. The soil carries no tension: above the depth of the crack, 2 c / (gamma sqrt(Ka)), it
/// exerts no pressure, and none on a wall that ends there.
double rankine_active_force(double phi, double cohesion, double unit_weight, double height);
/// Returns the passive force per metre of wall [N/m]: Pp = gamma H^2 Kp / 2 + 2 c H sqrt(Kp).
double rankine_passive_force(double phi, double cohesion, double unit_weight, double height);

/// Case of a flat blade of `width` w at `depth` d.
struct BladeCase {
  /// Friction in the soil and on the blade.
  double phi = 0, delta = 0;
  /// Alpha, angle of the blade's face with the ground ahead; 90 degrees: upright.
  double rake = 0;
  /// d, w [m].
  double depth = 0, width = 1;
  /// gamma, c and ca.
  double unit_weight = 0, cohesion = 0, adhesion = 0;
  /// q, on the ground ahead.
  double surcharge = 0;
};
/// Force on a blade. A wedge of soil slides up between the blade and a rupture plane that rises
/// from the edge at an angle beta. All models below choose the beta of the least force. With the
/// resultant P, delta off the blade's normal, the force on the blade is H = P sin(alpha + delta) +
/// ca d w cot(alpha) along the ground and V = P cos(alpha + delta) - ca d w downwards.
struct BladeForce {
  /// Rupture angle.
  double beta = 0;
  /// P [N].
  double force = 0;
  /// H [N].
  double horizontal = 0;
  /// V [N].
  double vertical = 0;
};
/// Returns the force of a planar wedge, exact for it [Reece 1964]: P = (gamma d^2 Ng + c d Nc + ca
/// d Na + q d Nq) w with D = cos(alpha + delta) + sin(alpha + delta) cot(beta + phi), Ng = (cot
/// alpha + cot beta) / (2 D), Nc = (1 + cot beta cot(beta + phi)) / D, Na = (1 - cot alpha cot(beta
/// + phi)) / D, Nq = (cot alpha + cot beta) / D.
BladeForce reece_wedge(const BladeCase& blade);
/// Returns the force on a narrow blade with crescents of soil at its sides [McKyes 1977]. With the
/// wedge's length r = d (cot alpha + cot beta) and s = sqrt(1 - (cot alpha / (cot alpha + cot
/// beta))^2): Ng = r / (2 d) (1 + 2 r s / (3 w)) / D, Nc = (1 + cot beta cot(beta + phi)) (1 + r s
/// / w) / D, Nq = r / d (1 + r s / w) / D, no adhesion. For w >> d it is the planar wedge.
BladeForce mckyes_ali(const BladeCase& blade);
/// Returns the force of dry sand cut by a blade of `length` [m] along its face
/// [Miedema 2014, chapter 5]. The layer cut, of thickness t = d sin(alpha + beta) / sin(beta),
/// rides up the whole blade and by the depth of the cut beyond it, unsupported and unslumped: P =
/// gamma w t (length + d + d cos(alpha + beta) / (2 sin beta)) sin(beta + phi) / sin(alpha + beta +
/// delta + phi). It estimates the largest force, 2-D, without inertia (0.3 N at 0.05 m/s). Takes no
/// cohesion, adhesion or surcharge.
BladeForce riding_layer(const BladeCase& blade, double length);
/// Returns the force of a planar wedge under ground of any shape [Coulomb 1776]: P = gamma w A
/// sin(beta + phi) / sin(alpha + beta + delta + phi), A the area between blade, rupture plane and
/// surface. `surface(x)` is the ground's height over the blade's edge at x ahead of the edge; the
/// blade's upper edge lies `height` over it [m]. For a rake of 90 degrees at most; takes no
/// cohesion, adhesion or surcharge.
BladeForce wedge_under(const BladeCase& blade, double height,
                       const std::function<double(double)>& surface);

// Bearing capacity of a strip footing on weightless soil, associated flow: p = c Nc + q Nq.

/// Returns the factor of the surcharge q [Reissner 1924]: Nq = exp(pi tan phi) tan^2(45 deg + phi /
/// 2).
double bearing_nq(double phi);
/// Returns the factor of the cohesion c [Prandtl 1920]: Nc = (Nq - 1) cot phi; pi + 2 at phi = 0.
double bearing_nc(double phi);
/// Returns the friction angle phi* that soil of zero dilatancy mobilises in a rigid-plastic
/// mechanism [Davis 1968]: tan phi* = sin phi.
double davis_angle(double phi);

// Height [m] of a vertical cut.

/// Returns the height at which a vertical cut fails by a slip circle [Taylor 1948]: Hc = 3.83 c /
/// gamma tan(45 deg + phi / 2).
double cut_critical_height(double phi, double cohesion, double unit_weight);
/// Returns the height that needs no tension anywhere, the depth of the tension crack: 2 c / gamma
/// tan(45 deg + phi / 2) [Terzaghi 1943].
double cut_no_tension_height(double phi, double cohesion, double unit_weight);

// Granular collapse of a column of height H0: a = H0 / L0 (plane, released on one side) or H0 / R0
// (axisymmetric). Run-out is (front - L0) / L0 with the front at rest; heights are those of the
// deposit. Fits to experiments, independent of the grains.

/// Returns the plane run-out [Lube 2005]: 1.2 a below a = 1.8, 1.9 a^(2/3) above 2.8, joined by a
/// line.
double lube_plane_run_out(double a);
/// Returns the axisymmetric run-out [Lube 2004]: 1.24 a below a = 1.7, 1.6 a^(1/2) above.
double lube_axisymmetric_run_out(double a);
/// Returns H / R0, axisymmetric [Lajeunesse 2004]: a below 0.74, then 0.74.
double lajeunesse_axisymmetric_height(double a);
/// Returns H / L0, plane [Lajeunesse 2005]: a below 0.7, then a^(1/3).
double lajeunesse_plane_height(double a);
/// Returns H / L0, plane [Lube 2005]: a below 1.15, then a^(2/5).
double lube_plane_height(double a);

/// Returns the slope at which soil of zero dilatancy flows: atan(sin phi). Stress and strain rate
/// have common axes in the flow, so that the plane along the slope carries at most tau / sigma_n =
/// sin phi [Davis 1968].
double flow_angle(double phi);

}  // namespace navvy::lab
