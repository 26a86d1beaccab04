// SPDX-License-Identifier: Apache-2.0
// The path of the bucket's tip through soil, and the reaction when the arm stalls.
#pragma once

#include "control/activity.h"
#include "control/stance.h"

namespace navvy::control {

/// The wanted pose of the bucket's tip in the vertical plane of a point, converted to joint angles
/// every control step.
///
/// The caller moves `z` and `angle` at speeds scaled by `slow`. When soil or rock holds the tip,
/// the path waits, then rises. A bucket that presses on the ground and lifts the machine's nose is
/// relieved at once. Part of an activity's state.
class TipPath {
 public:
  /// Wanted height of the tip [m] in W, without `lift`.
  double z = 0;
  /// Wanted angle of the line from pin to tip over the horizontal [rad].
  double angle = 0;
  /// Angle that the arm can reach there [rad].
  double reached = 0;
  /// Amount by which the path is raised because the arm stalled or the machine's nose rose [m].
  double lift = 0;
  /// Share of the path's speed that the machine can follow.
  double slow = 1;

  /// Starts at W (p, height) without a stall. Returns the joint angles of that pose, along the
  /// shorter arc.
  Axes start(const OperatorContext& place, const Stance& stance, const Vec2& p, double height,
             double tip_angle);
  /// Commands the tip to W (p, z + lift) and monitors how it follows; `dt` [s]. While `curling`, a
  /// machine that the bucket pulls over is not relieved by rising, which would pull it further.
  void follow(OperatorContext& place, const Stance& stance, const Vec2& p, const Observation& seen,
              double dt, bool curling);

  void visit(Archive& a);

 private:
  // The arm's solution for one wanted pose.
  struct Solution {
    Axes q;
    // Angle of the tip over the horizontal, the possible one nearest to the wanted [rad].
    double angle = 0;
    // False: out of reach.
    bool found = false;
  };
  Solution solve(const OperatorContext& place, const Stance& stance, const Vec2& p,
                 double height) const;
  void feel_stall(const OperatorContext& place, const Stance& stance, const Observation& seen,
                  double dt, bool curling);

  // Time for which the tip has been held [s].
  double stall_ = 0;
};

}  // namespace navvy::control
