// SPDX-License-Identifier: Apache-2.0
// The machine's stance while its arm works.
#pragma once

#include <array>

#include "control/arm_kinematics.h"
#include "core/archive.h"
#include "core/math.h"

namespace navvy::control {

/// Low-pass filtered pose of the chassis, and its inclination when the bucket last went down. Tip
/// paths in W are computed from this pose, so that the arm does not respond to every oscillation on
/// the tyres. Part of an activity's state.
class Stance {
 public:
  /// Starts from the present pose of the base link.
  void begin(const Pose& X_WB);
  /// Filters the pose with a time constant of 0.25 s; `dt` [s].
  void follow(const Pose& X_WB, double dt);
  /// Returns the filtered pose of the swing axis' frame S in W at zero swing.
  Pose swing_frame(const ArmKinematics& arm) const;
  /// Takes the present inclination as the reference: ground that yields under the wheels tilts the
  /// machine permanently, which is no reason to stop.
  void settle();
  /// Returns 1 while the machine stands as it did when it last settled, falling to 0 when the
  /// bucket tilts it by 3 deg.
  double footing(const Pose& X_WB) const;
  /// Returns by how much the side to which the arm points has risen since then [rad]; negative when
  /// it sank. `swing` [rad].
  double rise(const Pose& X_WB, const ArmKinematics& arm, double swing) const;

  void visit(Archive& a) {
    a("base", base_);
    a("up", up_);
  }

 private:
  std::array<double, 7> base_ = {0, 0, 0, 1, 0, 0, 0};  // x y z [m], quaternion w x y z
  // The base's z axis in W when it last settled.
  std::array<double, 3> up_ = {0, 0, 1};
};

}  // namespace navvy::control
