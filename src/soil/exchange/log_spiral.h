// SPDX-License-Identifier: Apache-2.0
// Height at which a face of cohesive soil stands: the upper bound for rotation of the soil on a
// logarithmic spiral.
#pragma once

#include <vector>

namespace navvy::soil {

/// Returns the stability number gamma H / c [-] of a plane face that rises from its toe to level
/// ground: unit weight x largest height / cohesion. `friction_angle`: of the soil [rad]; `face`:
/// angle of the face above horizontal [rad].
///
/// The result is the minimum over all logarithmic spirals through the toe [Chen 1975]. It is 3.83
/// tan(45 deg + phi / 2) for a vertical face, and infinite for faces no steeper than the friction
/// angle, which stand without cohesion.
double stability_number(double friction_angle, double face);

/// Heights at which faces fail in soil of one friction angle, tabulated by the angle of the face.
class FaceHeights {
 public:
  /// Computes the table for this friction angle [rad].
  explicit FaceHeights(double friction_angle);

  /// Returns the largest height [m] at which a face stands that recedes horizontally by `setback`
  /// [m] from toe to top. `strength`: cohesion / unit weight [m]; `highest`: upper limit of the
  /// result [m]. Returns 0 without cohesion.
  double height(double strength, double setback, double highest) const;

 private:
  /// Number of intervals of the table.
  static constexpr int kFaces = 64;

  /// Returns 1 / stability_number of a face at this angle [rad], interpolated in the table.
  double inverse(double face) const;

  /// Friction angle of the soil [rad].
  double friction_angle_;
  /// Table of 1 / stability number, at equal steps of the face angle from the friction angle to
  /// vertical.
  std::vector<double> inverse_;
};

}  // namespace navvy::soil
