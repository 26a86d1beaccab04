// SPDX-License-Identifier: Apache-2.0
// Moves of the arm between two poses in joint space, at the speed of an unhurried operator.
#pragma once

#include "control/activity.h"

namespace navvy::control {

/// Speed and timing of an arm move.
struct Pace {
  /// Factor on the usual joint rates [-].
  double share = 1;
  /// Fraction of the swing's duration after which boom, stick and bucket start to move [-].
  double arm_delay = 0;
};

/// A move of the four arm joints (swing, boom, stick, bucket) from one pose to another. Each joint
/// follows a smooth profile that starts and ends at rest.
///
/// The object only computes commands: `advance` writes the commanded angles to
/// OperatorContext::handover.q. A move is part of an activity's state.
class ArmMove {
 public:
  /// Starts a move from the currently commanded angles to the angles `to` [rad]. The slowest joint
  /// sets the duration. A joint moves at its usual rate, scaled by `pace`, but never faster than a
  /// fixed fraction of its own speed limit.
  void start(const OperatorContext& place, const Axes& to, const Observation& seen, Pace pace);
  /// Starts a move of the bucket joint only, from its current angle to the angle at which the soil
  /// falls out.
  void open_bucket(const OperatorContext& place, const Observation& seen);
  /// Computes the commanded angles `since` [s] after the start of the move. Returns true when the
  /// move is over: the arm has arrived or come to rest after the move's duration, or it is more
  /// than 2 s late. In the last case a warning with the phase name `phase` is logged.
  bool advance(OperatorContext& place, const Observation& seen, double since, const char* phase);
  /// Returns the duration of the commanded move [s]. The machine may arrive later.
  double duration() const;
  /// Returns the final angle of axis 0 to 3 (swing, boom, stick, bucket) [rad].
  double target(std::size_t axis) const { return to_[axis]; }

  /// Saves or loads the move.
  void visit(Archive& a);

 private:
  // Joint angles at the start and at the end of the move [rad].
  Axes from_{}, to_{};
  // Duration of the swing; delay and duration of the move of boom, stick and bucket [s].
  double swing_time_ = 0, arm_delay_ = 0, arm_time_ = 0;
};

}  // namespace navvy::control
