// SPDX-License-Identifier: Apache-2.0
// Height at which a face of cohesive soil stands: the upper bound from blocks that rotate on a log
// spiral.
#pragma once

#include <vector>

namespace navvy::soil {

/// Returns the stability number gamma H / c [-] of a plain face that rises at `face` [rad] from its
/// toe to level ground, in soil of friction `friction_angle` [rad]: the minimum over all log
/// spirals through the toe [Chen 1975]. It is infinite for faces no steeper than the friction
/// angle, which stand without cohesion, and 3.83 tan(45 deg + phi / 2) for a vertical face.
double stability_number(double friction_angle, double face);

/// Heights at which faces of one friction angle fail, tabulated over the angle of the face.
class FaceHeights {
 public:
  /// Tabulates the faces of soil with this friction angle [rad].
  explicit FaceHeights(double friction_angle);

  /// Returns the largest height [m], at most `highest`, at which soil of cohesion / unit weight
  /// `strength` [m] stands with a face that falls back by `setback` [m]. 0 without cohesion.
  double height(double strength, double setback, double highest) const;

 private:
  static constexpr int kFaces = 64;

  /// Returns 1 / stability number of a face of this angle [rad], interpolated.
  double inverse(double face) const;

  double friction_angle_;
  // 1 / stability number, at equal steps from the friction angle to a vertical face.
  std::vector<double> inverse_;
};

}  // namespace navvy::soil
