// SPDX-License-Identifier: Apache-2.0
// Bearing capacity q of soil that flows out from under a load of width b at the depth z, and the
// passive resistance of soil that is pushed ahead. Both follow [Terzaghi 1943]. c is the cohesion,
// phi the friction angle and gamma the weight per volume of the soil:
//
//   q = c Nc + gamma z Nq + gamma b Ngamma / 2
//   Nq = a^2 / (2 cos^2(45 deg + phi/2)),  a = exp((3 pi/4 - phi/2) tan phi)
//   Nc = (Nq - 1) cot phi
//   Ngamma = 2 (Nq + 1) tan phi / (1 + 0.4 sin 4 phi)   [Coduto 2001], within 20 % of Terzaghi's
//   table
//
// Loose soil fails by local shear, for which c and tan phi are reduced to two thirds.
#pragma once

#include "terramechanics/ground_query.h"
#include "terramechanics/shear.h"

namespace navvy::terramechanics {

/// Terzaghi's dimensionless bearing capacity factors for one friction angle.
struct BearingFactors {
  /// Factors Nc of cohesion, Nq of surcharge and Ngamma of soil weight [-].
  double c = 0, q = 0, gamma = 0;

  /// Returns the factors for a friction angle phi, given as `tan_phi`. A negative `tan_phi` counts
  /// as 0, for which the factors are Nc = 5.71, Nq = 1 and Ngamma = 0.
  static BearingFactors of(double tan_phi);
};

/// Returns the bearing capacity [Pa] of the ground under a long plate of `width` [m] whose
/// underside is `depth` [m] below the surface; 0 on a firm floor.
///
/// Soil in bank state or denser fails by general shear, fully swollen soil by local shear (two
/// thirds of c and tan phi). Between these two states the strength is interpolated linearly in the
/// volume ratio.
double bearing_capacity(const SoilState& ground, double width, double depth);

/// Returns how much [m] of a plate's sinkage from depth `from` to depth `to` [m] is due to soil
/// that flows aside, 0 to `to` - `from`. The rest of the sinkage compacts the soil.
///
/// As long as the ground supports the plate's pressure, the plate sinks only by compaction. At
/// greater depths z the ground transmits at most its bearing capacity q(z). That pressure compacts
/// the soil by the sinkage z_c at which Bekker's law (plate.h) gives it: k z_c^n = q(z). The
/// remaining depth z - z_c flows at constant volume. `width` is the plate's shorter side [m].
/// Returns 0 on a firm floor.
double pushed_depth(const SoilState& ground, double width, double from, double to);

/// Returns the passive resistance [N] of soil to a vertical front of `width` b and `depth` z [m]
/// that is pushed into it; 0 on a firm floor and for a depth <= 0:
///
///   R = b (2/3 c z Kc + gamma z^2 Kgamma / 2),   Kc = (Nc' - tan phi') cos^2 phi'
///   Kgamma = (2 Ngamma' / tan phi' + 1) cos^2 phi',   tan phi' = 2/3 tan phi
///
/// gamma is the soil's weight per volume, and primes mark values of local shear. This is the
/// bulldozing resistance of [Bekker 1969] with the factors of local shear, as [Wong 2008] gives it
/// for tyres.
double passive_resistance(const SoilState& ground, double width, double depth);

/// Returns the bulldozing resistance [N] that a rolling rim mobilises in the soil ahead of it. The
/// rim has `width` and `radius` r [m] and cuts `depth` z [m] deep.
///
/// `advance` is the wheel's travel speed divided by its rim speed, v / (omega r): 1 - s if driven
/// and 1 / (1 + s) if braked, with the slip s of WheelCase. It is infinite for a locked rim and
/// negative for a rim that turns backwards; both mobilise the full passive_resistance(). A rim that
/// spins in place (`advance` 0) pushes no soil ahead.
///
/// In between, a soil element at depth d meets the rim at the angle theta, cos theta = 1 - (z - d)
/// / r. Until it is below the axle, the rim pushes it ahead by j = r (advance theta - sin theta).
/// The element resists with the share 1 - exp(-j / K) of its passive pressure [Janosi 1961].
double bulldozing(const SoilState& ground, double width, double radius, double depth,
                  double advance);

/// Returns the resistance [N] of the soil beside a disc of `radius` r [m] that has sunk by `depth`
/// [m] and moves sideways by `aside` [-] per distance that it travels: the tangent of its slip
/// angle, infinite for a disc that moves only sideways. The sign of `aside` does not matter.
///
/// The sunken segment of the side wall meets the passive_resistance() of the soil, depth by depth.
/// Soil that the wall has passed by the distance x is pushed aside by x `aside` and mobilised by
/// that much [Janosi 1961].
double side_wall_resistance(const SoilState& ground, double radius, double depth, double aside);

}  // namespace navvy::terramechanics
