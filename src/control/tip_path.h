// SPDX-License-Identifier: Apache-2.0
// The bucket's tip along a path through soil, and what happens when the arm stalls.
#pragma once

#include "control/activity.h"
#include "control/stance.h"

namespace navvy::control {

/// The wanted pose of the bucket's tip in the vertical plane of a point, turned into joint angles
/// every control step.
///
/// Whoever uses it moves `z` and `angle` at speeds times `slow`; held by soil or rock the path
/// waits, then rises. A bucket that bears on the ground and lifts the machine's nose is relieved at
/// once. Part of an activity's memory.
class TipPath {
 public:
  double z = 0;        ///< wanted height of the tip [m] in W, without `lift`
  double angle = 0;    ///< wanted angle of the line pin to tip over the horizontal [rad]
  double reached = 0;  ///< the angle that the arm can give there [rad]
  /// The path is raised by so much because the arm stalled or the machine's nose rose [m].
  double lift = 0;
  double slow = 1;  ///< share of the path's speed that the machine follows

  /// Begins at W (p, z), free of any stall; the joint angles of that pose, by the short way round.
  Axes start(const OperatorContext& place, const Stance& stance, const Vec2& p, double height,
             double tip_angle);
  /// Commands the tip to W (p, z + lift) and feels how it follows; `dt` [s]. While `curling`, a
  /// machine that the bucket pulls over is not relieved by rising: that would pull it further.
  void follow(OperatorContext& place, const Stance& stance, const Vec2& p, const Observation& seen,
              double dt, bool curling);

  void visit(Archive& a);

 private:
  // The arm's answer to one wanted pose.
  struct Solution {
    Axes q;
    double angle = 0;    // of the tip over the horizontal, the nearest possible to the wish [rad]
    bool found = false;  // false: out of reach
  };
  Solution solve(const OperatorContext& place, const Stance& stance, const Vec2& p,
                 double height) const;
  void feel_stall(const OperatorContext& place, const Stance& stance, const Observation& seen,
                  double dt, bool curling);

  double stall_ = 0;  // [s] that the tip has been held
};

}  // namespace navvy::control
