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
  /// Acceleration of the swing [rad/s2]; 0 for the smooth profile at the usual rate.
  double swing_acceleration = 0;
  /// True if the swing waits until `release_swing` is called.
  bool hold_swing = false;
};

/// Returns the acceleration that the swing motor gives upper structure and arm at the joint angles
/// `q` with `load` [kg] in the bucket, less a reserve [rad/s2].
double swing_acceleration(const OperatorContext& place, const ArmAngles& q, double load,
                          const Observation& seen);

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
  /// Starts the swing of a move that holds it, `since` [s] after the start of the move.
  void release_swing(double since);
  /// Starts to open the bucket to the angle at which the soil falls out, `since` [s] after the
  /// start of the move, while the other joints go on.
  void open_on_the_way(const OperatorContext& place, const Observation& seen, double since);
  /// Computes the commanded angles `since` [s] after the start of the move. Returns true when the
  /// move is over: the arm has arrived or come to rest after the move's duration, or it is more
  /// than 2 s late. In the last case a warning with the phase name `phase` is logged.
  bool advance(OperatorContext& place, const Observation& seen, double since, const char* phase);
  /// Returns the angles of the move `since` [s] after its start, without the bucket's opening
  /// [rad].
  Axes at(double since) const;
  /// Returns the time after the start of the move at which boom, stick and bucket start [s].
  double arm_delay() const { return arm_delay_; }
  /// Returns the duration of the commanded move [s]. The machine may arrive later.
  double duration() const;
  /// Returns the durations of the swing, and of the move of boom, stick and bucket [s].
  double swing_time() const { return swing_time_; }
  double arm_time() const { return arm_time_; }
  /// Returns the duration of the bucket's opening [s]; 0 before it has started.
  double open_time() const { return open_time_; }
  /// Returns the final angle, with the opening of the bucket, of axis 0 to 3 (swing, boom, stick,
  /// bucket) [rad].
  double target(std::size_t axis) const { return to_[axis] + (axis == 3 ? open_by_ : 0); }

  /// Saves or loads the move.
  void visit(Archive& a);

 private:
  // Joint angles at the start and at the end of the move [rad].
  Axes from_{}, to_{};
  // Duration of the swing; delay and duration of the move of boom, stick and bucket [s].
  double swing_time_ = 0, arm_delay_ = 0, arm_time_ = 0;
  // Time after the start of the move at which the swing starts [s]; negative while it is held.
  double swing_at_ = 0;
  // Share of its duration in which the swing accelerates, and brakes; 0 for the smooth profile.
  double swing_ramp_ = 0;
  // Start [s], duration [s] and angle [rad] of the bucket's opening; a negative start: none.
  double open_at_ = -1, open_time_ = 0, open_by_ = 0;
};

}  // namespace navvy::control
