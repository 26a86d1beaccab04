// SPDX-License-Identifier: Apache-2.0
// Moves of the arm in joint space, as an unhurried operator makes them.
#pragma once

#include "control/activity.h"

namespace navvy::control {

/// How a move is made.
struct Pace {
  double share = 1;  ///< of the usual rates
  /// Boom, stick and bucket start when this share of the swing's time is over.
  double arm_delay = 0;
};

/// A move of swing, boom, stick and bucket between two poses, each axis with a smooth profile (at
/// rest at both ends).
///
/// Commands only: it writes Workplace::handover.q, and ends when the machine has followed. Part of
/// an activity's memory.
class ArmMove {
 public:
  /// From the commanded angles to `to` [rad]. Its time follows from the slowest axis, at the usual
  /// rates or at a share of the joints' own limits, whichever is slower.
  void start(const OperatorContext& place, const Axes& to, const Observation& seen, Pace pace);
  /// Opens the bucket where it is, until what it holds falls out.
  void open_bucket(const OperatorContext& place, const Observation& seen);
  /// Goes on with the move, `since` [s] after its start. True when the machine has arrived, or has
  /// had the move's time and a little patience; `phase` names the move in the warning then.
  bool advance(OperatorContext& place, const Observation& seen, double since, const char* phase);
  /// Of the commanded move [s].
  double duration() const;
  double target(std::size_t axis) const { return to_[axis]; }

  void visit(Archive& a);

 private:
  // Ends of the move [rad], each axis on its own smooth profile between them.
  Axes from_{}, to_{};
  double swing_time_ = 0, arm_delay_ = 0, arm_time_ = 0;  // [s]
};

}  // namespace navvy::control
