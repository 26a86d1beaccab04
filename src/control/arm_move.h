// SPDX-License-Identifier: Apache-2.0
// Moves of the arm in joint space at the pace of an unhurried operator.
#pragma once

#include "control/activity.h"

namespace navvy::control {

/// Pace of a move.
struct Pace {
  /// Share of the usual joint rates.
  double share = 1;
  /// Share of the swing's time after which boom, stick and bucket start.
  double arm_delay = 0;
};

/// A move of swing, boom, stick and bucket between two poses; each axis follows a smooth profile
/// that is at rest at both ends.
///
/// Only commands: it writes OperatorContext::handover.q, and ends when the machine has followed.
/// Part of an activity's state.
class ArmMove {
 public:
  /// Starts a move from the commanded angles to `to` [rad]. The slowest axis sets the duration, at
  /// the usual rates or at a share of the joints' own limits, whichever is slower.
  void start(const OperatorContext& place, const Axes& to, const Observation& seen, Pace pace);
  /// Starts to open the bucket where it is, until its load falls out.
  void open_bucket(const OperatorContext& place, const Observation& seen);
  /// Continues the move, `since` [s] after its start. Returns true when the machine has arrived, or
  /// when the move's time and some patience are over; the warning then names `phase`.
  bool advance(OperatorContext& place, const Observation& seen, double since, const char* phase);
  /// Duration of the commanded move [s].
  double duration() const;
  double target(std::size_t axis) const { return to_[axis]; }

  void visit(Archive& a);

 private:
  // Start and end of the move [rad]; each axis follows its own smooth profile between them.
  Axes from_{}, to_{};
  double swing_time_ = 0, arm_delay_ = 0, arm_time_ = 0;  // [s]
};

}  // namespace navvy::control
