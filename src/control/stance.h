// SPDX-License-Identifier: Apache-2.0
// Filtered pose of a machine while its arm works.
#pragma once

#include <array>

#include "control/arm_kinematics.h"
#include "core/archive.h"
#include "core/math.h"

namespace navvy::control {

/// Low-pass filtered pose of the chassis, and a reference inclination.
///
/// Paths of the bucket's tip are given in W and converted to joint angles with the filtered pose,
/// so that the arm does not respond to every oscillation of the chassis on its tyres. The reference
/// inclination is set by `begin` and `settle`. A stance is part of an activity's state.
class Stance {
 public:
  /// Sets the filtered pose and the reference inclination from `X_WB`, the current pose of the base
  /// link.
  void begin(const Pose& X_WB);
  /// Updates the filtered pose from the current pose `X_WB`. The filter's time constant is 0.25 s;
  /// `dt` [s] is the length of the control step.
  void follow(const Pose& X_WB, double dt);
  /// Returns the filtered pose X_WS of the swing axis frame S in W, for a swing angle of zero.
  Pose swing_frame(const ArmKinematics& arm) const;
  /// Sets the reference inclination to the current filtered one. Call it when the bucket is about
  /// to enter the ground: yielding ground has tilted the machine permanently by then, and that tilt
  /// must not count as caused by the bucket.
  void settle();
  /// Returns 1 while the inclination differs by at most 1.5 deg from the reference. Beyond that,
  /// the value falls linearly to 0 at 3 deg.
  double tilt_factor(const Pose& X_WB) const;
  /// Returns the angle [rad] by which the machine has pitched since the reference was set, in the
  /// direction of the arm: positive if the side towards the bucket has risen, negative if it has
  /// sunk. `swing` is the current swing angle [rad].
  double rise(const Pose& X_WB, const ArmKinematics& arm, double swing) const;

  /// Saves or loads the filtered pose and the reference inclination.
  void visit(Archive& a) {
    a("base", base_);
    a("up", up_);
  }

 private:
  // Filtered pose of the base link: x y z [m], then the quaternion w x y z.
  std::array<double, 7> base_ = {0, 0, 0, 1, 0, 0, 0};
  // Unit vector along the base link's z axis in W when the reference was set.
  std::array<double, 3> up_ = {0, 0, 1};
};

}  // namespace navvy::control
