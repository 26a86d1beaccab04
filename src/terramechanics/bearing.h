// SPDX-License-Identifier: Apache-2.0
// Bearing capacity of soil that flows out from under a load, and the passive resistance of soil
// that is pushed ahead. Both follow Terzaghi's theory [Terzaghi 1943].
//
//   q = c Nc + gamma z Nq + gamma b Ngamma / 2
//   Nq = a^2 / (2 cos^2(45 deg + phi/2)),  a = exp((3 pi/4 - phi/2) tan phi)
//   Nc = (Nq - 1) cot phi
//   Ngamma = 2 (Nq + 1) tan phi / (1 + 0.4 sin 4 phi)   [Coduto 2001], within 20 % of his table
//
// Loose soil fails by local shear: with two thirds of c and of tan phi.
#pragma once

#include "terramechanics/ground_query.h"
#include "terramechanics/shear.h"

namespace navvy::terramechanics {

/// Bearing capacity factors Nc, Nq and Ngamma [-].
struct BearingFactors {
  double c = 0, q = 0, gamma = 0;

  /// Computes the factors for tan phi >= 0. Without friction they are 5.71, 1 and 0.
  static BearingFactors of(double tan_phi);
};

/// Returns the bearing capacity [Pa] of the ground under a long plate of `width` [m] at a depth of
/// `depth` [m]. Bank state and denser soil fails by general shear, fully swollen soil by local
/// shear; in between, both are interpolated.
double bearing_capacity(const SoilState& ground, double width, double depth);

/// Returns the part [m] of a sinkage from `from` to `to` [m] in which soil flows aside instead of
/// being compacted.
///
/// As long as the ground supports the plate's pressure, it sinks by compaction alone. Deeper, the
/// ground transmits at most its bearing capacity q(z), which compacts it by the sinkage z_c of the
/// plate's own law, k z_c^n = q(z); the rest z - z_c flows at constant volume.
double pushed_depth(const SoilState& ground, double width, double from, double to);

/// Returns the passive resistance [N] of soil ahead of a front of `width` [m] and `depth` [m]:
///
///   R = b (2/3 c z Kc + gamma z^2 Kgamma / 2),   Kc = (Nc' - tan phi') cos^2 phi'
///   Kgamma = (2 Ngamma' / tan phi' + 1) cos^2 phi',   tan phi' = 2/3 tan phi
///
/// This is the bulldozing resistance of [Bekker 1969] with the factors of local shear, as
/// [Wong 2008] gives it for tyres.
double passive_resistance(const SoilState& ground, double width, double depth);

/// Returns the mobilised bulldozing resistance [N] ahead of a round rim of `radius` [m].
///
/// `advance` is the wheel's travel over the rim's, v / (omega r): 1 - s driven, 1 / (1 + s) braked;
/// infinite or negative for a rim that stands or turns backwards. A soil element of depth d meets
/// the rim at the angle theta, cos theta = 1 - (z - d) / r, and is pushed ahead by j = r (advance
/// theta - sin theta) until it is below the axle. It resists by the share 1 - exp(-j / K)
/// [Janosi 1961]. A rim that spins in place pushes nothing ahead, a locked rim mobilises the full
/// resistance.
double bulldozing(const SoilState& ground, double width, double radius, double depth,
                  double advance);

}  // namespace navvy::terramechanics
