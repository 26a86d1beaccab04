// SPDX-License-Identifier: Apache-2.0
// Passive earth pressure on a rough upright wall or blade, and the triaxial strength of a soil
// whose friction angle in plane strain is phi.
//
// A wedge with a planar rupture surface gives an upper bound. With tool friction the true
// rupture surface is curved, and the force of the planar wedge is 20 % too high at delta = 2 phi /
// 3 and 80 % too high at delta = phi. The reference for a rough tool is therefore the sum of two
// parts:
//   - for cohesion, adhesion and surcharge, the exact slip-line solution of weightless soil,
//   - for the weight, for which there is no closed-form solution, two bounds: Lancellotta's lower
// bound, and a log spiral that ends in Rankine's zone, which is the mechanism of Terzaghi and of
// the tables of Caquot and Kerisel.
// The sum is the usual superposition, which is on the safe (low) side. Units are SI, angles are in
// rad, and stresses are positive in compression. The ground is level, and the wall is pushed into
// it, so that the soil rises along the wall. The flow rule is associated; zero dilatancy may lower
// all values.
#pragma once

#include "lab/theory/formulas.h"

namespace navvy::lab {

/// Stress of the soil on a wall.
struct WallStress {
  /// Normal stress and shear stress [Pa]; the shear stress is positive where the soil pulls the
  /// wall upwards.
  double normal = 0, shear = 0;
};
/// Returns the passive stress on a rough upright wall in weightless soil under a surcharge, an
/// exact solution along slip lines [Sokolovskii 1965]. phi is the soil's friction angle, delta that
/// of soil on the wall [rad]; c is the cohesion, a the adhesion and q the surcharge [Pa]; sigma_n
/// and tau are the normal stress and the shear stress on the wall.
///
/// All pressures are counted from -c cot phi, so the pressure at the ground is p0 = (q + c cot phi)
/// / (1 - sin phi). From the ground to the wall the principal axes rotate by an angle t: p = p0
/// exp(2 t tan phi), sigma_n = p (1 + sin phi cos 2t) - c cot phi, tau = p sin phi sin 2t. t is the
/// angle at which tau = a + sigma_n tan delta. If the wall is rougher than the soil, the wall
/// itself is a slip line and t = pi/4 + phi/2. (t = pi/4 - phi/2 would be too small: the stress at
/// phi = delta = 30 deg would be 6.19 c instead of 6.72 c.)
WallStress passive_slip_line(double phi, double delta, double cohesion, double adhesion,
                             double surcharge);
/// Returns the coefficient of passive earth pressure on a rough wall for soil without cohesion:
/// normal stress on the wall / (gamma z), where gamma is the unit weight and z the depth. phi is
/// the soil's friction angle and delta that of soil on the wall [rad]; `delta` must be at most
/// `phi`. The result is a lower bound in closed form [Lancellotta 2002]: K = cos delta (cos delta +
/// sqrt(sin^2 phi - sin^2 delta)) / (1 - sin phi) exp(2 theta tan phi), 2 theta = asin(sin delta /
/// sin phi) + delta.
double passive_lancellotta(double phi, double delta);
/// Returns the same coefficient as passive_lancellotta from a log-spiral mechanism: the spiral
/// rises from the wall's toe and merges into Rankine's zone [Terzaghi 1943]. The equilibrium of
/// moments about the spiral's pole gives the force; the pole with the smallest force is taken.
///
/// The result divided by cos delta agrees with the tables of [Caquot 1948] within 2 % at delta =
/// 2 phi / 3 (4.0 and 5.3 at phi = 30 deg and delta = 10 and 20 deg), and within 5 % at delta =
/// phi.
double passive_log_spiral(double phi, double delta);

/// Bounds of the passive force on a rough upright blade, for the whole blade width.
struct PassiveBand {
  /// Lower bound of the force along the ground [N]: soil weight by Lancellotta's lower bound,
  /// cohesion, adhesion and surcharge by the slip-line solution.
  double low = 0;
  /// Upper bound of the force along the ground [N]: soil weight by the log spiral, the rest as for
  /// `low`.
  double high = 0;
  /// Upward force on the blade that belongs to `low` [N]; soil that rises along the blade causes
  /// it.
  double vertical = 0;
};
/// Returns the bounds of the passive force on an upright blade; the rake in `blade` is ignored. If
/// the friction angle on the blade is above phi, phi is used instead, because the soil then fails
/// internally before it slips on the blade.
PassiveBand rough_passive(const BladeCase& blade);

/// Returns the friction angle phi_t [rad] in triaxial compression and extension of a soil whose
/// friction angle in plane strain without dilatancy is `phi` [rad].
///
/// The yield surface is I1 I2 / I3 = kappa with the stress invariants I1, I2, I3
/// [Matsuoka 1974]. In plane strain without dilatancy the intermediate principal stress is the mean
/// of the other two, so kappa = (9 - 3 sin^2 phi) / (1 - sin^2 phi). With K, the ratio of the
/// largest to the smallest principal stress, 2 K^2 + (5 - kappa) K + 2 = 0 and sin phi_t = (K - 1)
/// / (K + 1). For phi = 35 deg, phi_t is 31.2 deg.
double matsuoka_nakai_triaxial(double phi);

}  // namespace navvy::lab
