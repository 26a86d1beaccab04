// SPDX-License-Identifier: Apache-2.0
// Passive earth pressure on a rough upright wall or blade, and the triaxial strength that belongs
// to a plane-strain phi.
//
// A planar wedge is an upper bound: with tool friction the rupture surface curves, and the wedge is
// a fifth too high at delta = 2 phi / 3 and four fifths at delta = phi. The reference for a rough
// tool is therefore
//   - for cohesion, adhesion and surcharge the exact slip-line solution of weightless soil,
//   - for the weight, which has no closed form, two bounds: Lancellotta's lower bound, and a log
//     spiral that ends in Rankine's zone, the mechanism of Terzaghi and of the tables of Caquot and
//     Kerisel.
// Their sum is the usual superposition, on the safe (low) side. SI units, angles [rad], compression
// positive; level ground, the wall pushed into it, so that the soil rises along it. Associated
// flow; zero dilatancy may lower all values.
#pragma once

#include "lab/theory/formulas.h"

namespace navvy::lab {

/// Stress on the wall.
struct WallStress {
  /// [Pa]; shear is positive where soil pulls the wall up.
  double normal = 0, shear = 0;
};
/// Returns the stress of weightless soil under a surcharge q, exact along its slip lines
/// [Sokolovskii 1965]. With all pressures counted from -c cot phi, p0 = (q + c cot phi) / (1 - sin
/// phi) at the ground. The field turns by t towards the wall: p = p0 exp(2 t tan phi), sigma_n = p
/// (1 + sin phi cos 2t) - c cot phi, tau = p sin phi sin 2t. t is where tau = a + sigma_n tan
/// delta. A wall rougher than the soil is a slip line itself, t = pi/4 + phi/2. (At pi/4 - phi/2
/// the fan is not complete: stopping there gives 6.19 instead of 6.72 c at phi = delta = 30 deg.)
WallStress passive_slip_line(double phi, double delta, double cohesion, double adhesion,
                             double surcharge);
/// Returns normal stress / (gamma z) for soil of weight without cohesion, a lower bound in closed
/// form [Lancellotta 2002]: K = cos delta (cos delta + sqrt(sin^2 phi - sin^2 delta)) / (1 - sin
/// phi) exp(2 theta tan phi), 2 theta = asin(sin delta / sin phi) + delta. `delta` is at most phi.
double passive_lancellotta(double phi, double delta);
/// Returns the same by moments about the pole of a log spiral that rises from the toe and merges
/// into Rankine's zone [Terzaghi 1943], for the pole of the least force. Its force over cos delta
/// is that of the tables of [Caquot 1948] within 2 % at delta = 2 phi / 3 (4.0 and 5.3 at phi 30
/// deg and delta 10 and 20), within 5 % at delta = phi.
double passive_log_spiral(double phi, double delta);

/// Bounds of the force on a rough upright blade along the ground [N], for the whole width.
struct PassiveBand {
  /// Weight by Lancellotta, the rest by the slip lines.
  double low = 0;
  /// Weight by the log spiral.
  double high = 0;
  /// Lift on the blade that belongs to `low`, from soil that rises along it [N].
  double vertical = 0;
};
/// Returns the bounds. `blade` must be upright; a delta above phi counts as phi: the soil slips
/// internally first.
PassiveBand rough_passive(const BladeCase& blade);

/// Returns the friction angle in triaxial compression and extension of a soil whose angle in plane
/// strain without dilatancy is `phi`, by the surface I1 I2 / I3 = kappa [Matsuoka 1974]: kappa = (9
/// - 3 sin^2 phi) / (1 - sin^2 phi), as the middle stress is the mean of the other two there. With
/// K the ratio of the largest to the least stress, 2 K^2 + (5 - kappa) K + 2 = 0 and sin phi_t = (K
/// - 1) / (K + 1). 31.2 deg at phi 35 deg.
double matsuoka_nakai_triaxial(double phi);

}  // namespace navvy::lab
