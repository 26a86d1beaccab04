// SPDX-License-Identifier: Apache-2.0
// Closed forms and published formulas that rigs are held against. SI units, angles [rad], unit weights [N/m3].
#pragma once

#include <functional>

namespace navvy::lab {

// Earth pressure [Rankine 1857]: smooth vertical wall of height H.
double rankine_active(double phi);   ///< Ka
double rankine_passive(double phi);  ///< Kp
/// Force per metre of wall [N/m]; the active one without tension.
double rankine_active_force(double phi, double cohesion, double unit_weight, double height);
double rankine_passive_force(double phi, double cohesion, double unit_weight, double height);

/// What a flat blade of `width` at `depth` meets. `rake` is the angle of its face with the ground ahead (90 degrees:
/// upright); `surcharge` lies on the ground [Pa].
struct BladeCase {
  double phi = 0, delta = 0, rake = 0;
  double depth = 0, width = 1;
  double unit_weight = 0, cohesion = 0, adhesion = 0, surcharge = 0;
};
/// `force` is the resultant P along the normal-plus-friction direction, `beta` the rupture angle that makes it least.
struct BladeForce {
  double beta = 0, force = 0, horizontal = 0, vertical = 0;  ///< [rad], [N]; vertical: downwards on the blade
};
/// Planar wedge [Reece 1964], exact for it: P = (gamma d2 N_g + c d N_c + ca d N_a + q d N_q) w.
BladeForce reece_wedge(const BladeCase& blade);
/// Narrow blade with crescents at its sides [McKyes and Ali 1977].
BladeForce mckyes_ali(const BladeCase& blade);
/// Dry sand cut by a blade of `length` [m] along its face: the layer cut rides up the whole blade and by the depth of
/// the cut beyond it, unsupported and unslumped. An estimate of the largest force, 2-D [Miedema 2015, chapter 5;
/// without inertia, 0.3 N at 0.05 m/s]. Takes no cohesion, adhesion or surcharge.
BladeForce riding_layer(const BladeCase& blade, double length);
/// Coulomb's planar wedge under ground of any shape: `surface(x)` is its height over the blade's lip at x ahead of the
/// lip, the blade's upper edge lies `height` over the lip [m]. For a rake of 90 degrees at most; takes no cohesion,
/// adhesion or surcharge.
BladeForce wedge_under(const BladeCase& blade, double height, const std::function<double(double)>& surface);

// Bearing capacity of a strip footing on weightless soil [Prandtl 1920, Reissner 1924], associated flow.
double bearing_nq(double phi);
double bearing_nc(double phi);  ///< pi + 2 at phi = 0
/// Friction angle that soil of zero dilatancy mobilises in a rigid-plastic mechanism, tan = sin phi [Davis 1968].
double davis_angle(double phi);

/// Critical height of a vertical cut [m]: 3.83 c / gamma tan(45 + phi/2), and what holds without tension (2 instead
/// of 3.83).
double cut_critical_height(double phi, double cohesion, double unit_weight);
double cut_no_tension_height(double phi, double cohesion, double unit_weight);
/// Culmann's plane wedge: 4 c / gamma tan(45 + phi/2) [m].
double culmann_height(double phi, double cohesion, double unit_weight);

// Granular collapse. a = H0 / L0 or H0 / R0; run-out = (front - L0) / L0.
double lube_plane_run_out(double a);         ///< Lube 2005: 1.2 a below 1.8, 1.9 a^(2/3) above 2.8, between: linear
double lube_axisymmetric_run_out(double a);  ///< Lube 2004: 1.24 a below 1.7, 1.6 a^(1/2) above
double lajeunesse_axisymmetric_height(double a);  ///< H / R0: a below 0.74, then 0.74 [Lajeunesse 2004]
double lajeunesse_plane_height(double a);         ///< H / L0: a below 0.7, then a^(1/3) [Lajeunesse 2005]
double lube_plane_height(double a);               ///< H / L0: a below 1.15, then a^(2/5) [Lube 2005]

/// Slope at which soil of zero dilatancy flows: atan(sin phi).
double flow_angle(double phi);

}  // namespace navvy::lab
