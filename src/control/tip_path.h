// SPDX-License-Identifier: Apache-2.0
// Path of the bucket's tip through the soil, and the reaction when the soil holds the tip.
#pragma once

#include "control/activity.h"
#include "control/stance.h"

namespace navvy::control {

/// Converts the commanded position and angle of the bucket to joint angles in every control step.
/// The tip moves in the vertical plane of the trench.
///
/// The caller changes `z` and `angle` at speeds that it multiplies by `slow`. If soil or rock holds
/// the tip, the path first pauses and then rises. If the bucket presses on the ground so hard that
/// it lifts the machine on that side, the path rises immediately. A path is part of an activity's
/// state.
class TipPath {
 public:
  /// Commanded height of the tip in W [m], not including `lift`.
  double z = 0;
  /// Commanded angle of the line from the bucket's pin to its tip above the horizontal [rad].
  double angle = 0;
  /// Angle nearest to `angle` that the arm can reach at the commanded position [rad].
  double reached = 0;
  /// Height by which the path is currently raised, because the tip is held or the machine has been
  /// lifted [m].
  double lift = 0;
  /// Factor on the speed of the path, from 1 (the machine follows) to 0 (the path pauses) [-].
  double slow = 1;

  /// Starts a path at the point `p` (x, y) and the height `height` in W [m], with the bucket at the
  /// angle `tip_angle` [rad]. Returns the joint angles of that pose; the swing takes the shorter
  /// way from its commanded angle.
  Axes start(const OperatorContext& place, const Stance& stance, const Vec2& p, double height,
             double tip_angle);
  /// Parts of a scoop, in which the path responds differently to the machine.
  enum class Part {
    /// The tip moves down into the ground.
    kDown,
    /// The tip moves along a floor, whose height it keeps by feedback from its measured height.
    kAlong,
    /// The bucket curls. While the machine tilts, a held tip does not raise the path, because that
    /// would pull the machine over.
    kCurl
  };
  /// Commands the tip to the point `p` (x, y) in W [m] at the height `z + lift`, then updates
  /// `reached`, `lift` and `slow` from the machine's response. `dt` [s] is the length of the
  /// control step. The angles of the path go to OperatorContext::handover; the targets in `out` are
  /// ahead of them by the servo's own lag.
  void follow(OperatorContext& place, const Stance& stance, const Vec2& p, const Observation& seen,
              double dt, Part part, Command& out);

  /// Adds to the angles of OperatorContext::handover what the servos' targets are ahead of them, so
  /// that a move that starts there continues without a jump.
  void hand_over(OperatorContext& place) const;

  /// Saves or loads the path.
  void visit(Archive& a);

 private:
  // Result of the inverse kinematics for a commanded pose of the bucket.
  struct Solution {
    // Joint angles [rad]; those of boom, stick and bucket are unchanged if the pose is out of
    // reach.
    Axes q;
    // Possible angle nearest to the commanded one, above the horizontal [rad].
    double angle = 0;
    // False if the pose is out of reach.
    bool found = false;
  };
  // Computes the joint angles for the tip at `p` (x, y) and `height` in W [m].
  Solution solve(const OperatorContext& place, const Stance& stance, const Vec2& p,
                 double height) const;
  // Updates `slow` and `lift` from the lag of the tip, the load of the cylinders and the tilt of
  // the machine.
  void feel_stall(const OperatorContext& place, const Stance& stance, const Observation& seen,
                  double dt, bool curling);
  // Updates the correction of the tip's height from its measured height.
  void keep_level(const OperatorContext& place, const Observation& seen, double dt);

  // Filtered rates of the path's joint angles [rad/s].
  Axes rate_{};
  // Time for which the tip has been held [s]; decreases while it is free.
  double stall_ = 0;
  // Correction of the commanded height by feedback, and its part that adds up over time [m].
  double trim_ = 0, trim_sum_ = 0;
};

}  // namespace navvy::control
