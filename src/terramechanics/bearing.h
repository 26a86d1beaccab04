// SPDX-License-Identifier: Apache-2.0
// Soil that gives way as a mass instead of being compacted: what the ground bears before it flows
// out from under a load, and how soil ahead holds back what is pushed into it. Both after
// Terzaghi's theory of bearing capacity [Terzaghi 1943].
//
//   q = c Nc + gamma z Nq + gamma b Ngamma / 2
//   Nq = a^2 / (2 cos^2(45 deg + phi/2)),  a = exp((3 pi/4 - phi/2) tan phi),  Nc = (Nq - 1) cot
//   phi Ngamma = 2 (Nq + 1) tan phi / (1 + 0.4 sin 4 phi)      [Coduto 2001], within a fifth of his
//   table
//
// Soil that lies loose fails locally: with two thirds of c and of tan phi.
#pragma once

#include "terramechanics/ground_query.h"
#include "terramechanics/shear.h"

namespace navvy::terramechanics {

/// Nc, Nq, Ngamma [-].
struct BearingFactors {
  double c = 0, q = 0, gamma = 0;

  /// For tan phi >= 0; without friction 5.71, 1 and 0.
  static BearingFactors of(double tan_phi);
};

/// What the ground bears [Pa] under a long plate of `width` [m] that stands `depth` [m] deep.
/// General shear in bank state and denser, local shear in fully swollen soil, in proportion
/// between.
double bearing_capacity(const SoilState& ground, double width, double depth);

/// How much of a sinkage from `from` to `to` [m] flows aside [m] and is not compaction. A plate
/// stands as a foundation does as long as the ground bears its pressure, and only compaction lets
/// it sink. Deeper, the ground passes on no more than it bears: q(z) compacts it by the z_c of the
/// plate's own law, k z_c^n = q(z), and z - z_c flows at constant volume.
double pushed_depth(const SoilState& ground, double width, double from, double to);

/// Passive resistance [N] of the soil before a front of `width` [m] that stands `depth` [m] deep in
/// it:
///
///   R = b (2/3 c z Kc + gamma z^2 Kgamma / 2),   Kc = (Nc' - tan phi') cos^2 phi',
///   Kgamma = (2 Ngamma' / tan phi' + 1) cos^2 phi',   tan phi' = 2/3 tan phi
///
/// the bulldozing resistance of [Bekker 1969] with the factors of local shear, as [Wong 2008] gives
/// it for tyres.
double passive_resistance(const SoilState& ground, double width, double depth);

/// The same for a round rim of `radius` [m], as far as its motion mobilises it. `advance` is the
/// wheel's way over the rim's, v / (omega r): 1 - s driven, 1 / (1 + s) braked; endless or below 0
/// for a rim that stands or turns back.
///
/// From where the rim meets the soil of a depth d, at the angle theta, cos theta = 1 - (z - d) / r,
/// to below the axle it pushes it ahead by j = r (advance theta - sin theta), and that soil resists
/// by the share 1 - exp(-j / K) [Janosi 1961]. A rim that slips pushes nothing ahead of it, a
/// locked one all. One that turns pushes with what of it lies below its axle.
double bulldozing(const SoilState& ground, double width, double radius, double depth,
                  double advance);

}  // namespace navvy::terramechanics
