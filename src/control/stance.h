// SPDX-License-Identifier: Apache-2.0
// How a machine stands while its arm works.
#pragma once

#include <array>

#include "control/arm_kinematics.h"
#include "core/archive.h"
#include "core/math.h"

namespace navvy::control {

/// The chassis' pose with its shaking on the tyres smoothed away, and how upright it stood when the
/// bucket last went down. Tip paths in W are worked out from here, so that the arm does not answer
/// every sway. Part of an activity's memory.
class Stance {
 public:
  /// Takes the pose of the base link as it is.
  void begin(const Pose& X_WB);
  /// Follows it with a time constant of a quarter of a second; `dt` [s].
  void follow(const Pose& X_WB, double dt);
  /// Smoothed pose of the swing axis' frame S in W, at zero swing.
  Pose swing_frame(const ArmKinematics& arm) const;
  /// Takes how the machine stands by now, smoothed, as how it shall stand: ground that gives way
  /// under its wheels tilts it for good, which is no reason to stop.
  void settle();
  /// 1 while the machine stands as it did when it was last settled, 0 when the bucket tips it by 3
  /// deg.
  double footing(const Pose& X_WB) const;
  /// By how much the side that the arm points to has risen since then [rad]; negative where it
  /// sank. `swing` [rad].
  double rise(const Pose& X_WB, const ArmKinematics& arm, double swing) const;

  void visit(Archive& a) {
    a("base", base_);
    a("up", up_);
  }

 private:
  std::array<double, 7> base_ = {0, 0, 0, 1, 0, 0, 0};  // x y z [m], quaternion w x y z
  // The base's z axis in W when it was last settled
  std::array<double, 3> up_ = {0, 0, 1};
};

}  // namespace navvy::control
