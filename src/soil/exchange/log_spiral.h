// SPDX-License-Identifier: Apache-2.0
// How high a face of cohesive soil stands: the upper bound of a block that turns off it on a log
// spiral.
#pragma once

#include <vector>

namespace navvy::soil {

/// Stability number gamma H / c [-] of a plain face that rises at `face` [rad] from its toe to
/// level ground, in soil of friction `friction_angle` [rad]: the least over all log spirals through
/// the toe [Chen 1975]. Infinite for faces no steeper than the friction angle, which stand without
/// cohesion. 3.83 tan(45 deg + phi / 2) for a vertical face.
double stability_number(double friction_angle, double face);

/// Heights at which faces of one friction angle fail, tabulated over the face's angle.
class FaceHeights {
 public:
  explicit FaceHeights(double friction_angle);

  /// Largest height [m] at which soil of cohesion over unit weight `strength` [m] stands with a
  /// face that falls back by `setback` [m]; at most `highest` [m]. 0 without cohesion.
  double height(double strength, double setback, double highest) const;

 private:
  static constexpr int kFaces = 64;

  double inverse(double face) const;

  double friction_angle_;
  // 1 / stability number, evenly from the friction angle to a vertical face
  std::vector<double> inverse_;
};

}  // namespace navvy::soil
