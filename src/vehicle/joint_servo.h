// SPDX-License-Identifier: Apache-2.0
// Servo of a joint. It computes the velocity that moves the joint to its target within its limits.
// Independent of the physics engine.
#pragma once

#include "core/archive.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Limits of a joint at its current position, as magnitudes.
struct JointLimits {
  /// Largest effort in the positive and in the negative direction of the joint [N m|N].
  double effort_positive = 1e9, effort_negative = 1e9;
  /// Largest speed in the positive and in the negative direction [rad/s|m/s].
  double speed_positive = 1e9, speed_negative = 1e9;
  /// Inertia of all links that move with the joint, about or along its axis [kg m2|kg]; 0 if
  /// unknown.
  double inertia = 0;

  /// Saves, loads or hashes all limits.
  void visit(Archive& a);
};

/// Controller and valve of one joint. It turns a command into the velocity that the actuator should
/// reach in this step.
///
/// The valve takes 0.15 s to open fully. Near its target, a position servo slows down so that half
/// its effort can stop the load, or three quarters if the joint has no limits (a swing). When
/// commanded to zero velocity, it holds the position at which the joint stopped.
///
/// Call open(), demand() and settle() once per step, in this order.
class JointServo {
 public:
  /// Motion that the solver should give the joint in one step.
  struct Demand {
    /// Velocity to reach [rad/s|m/s].
    double velocity = 0;
    /// Smallest and largest effort that the solver may use to reach `velocity`, signed [N m|N].
    double effort_low = 0, effort_high = 0;
    /// Effort that is applied directly, without a target velocity, in mode kEffort [N m|N].
    double feed_forward = 0;
  };

  /// Sets the servo's command, which holds until it is replaced.
  void set(const JointInput& input) { input_ = input; }
  /// Returns the current command.
  const JointInput& input() const { return input_; }

  /// Moves the valve towards the command. Call it once per step, before demand().
  ///
  /// `limits` are the limits of `joint` at the position `q` [rad|m]; `qd` is its velocity
  /// [rad/s|m/s], `dt` the step [s].
  /// @return the velocity that the valve passes with enough oil [rad/s|m/s]; 0 in the modes without
  /// a valve (kFree and kEffort).
  double open(const scene::Joint& joint, const JointLimits& limits, double q, double qd, double dt);
  /// Returns true if the last open() left the valve clearly open. It returns false for a joint that
  /// holds its position or stalls, which takes hardly any oil.
  bool flows() const { return flows_; }
  /// Returns the motion for the solver in this step, if the joint's cylinder gets `share` (0 to 1)
  /// of the oil that its valve passes. The other parameters are those of open().
  Demand demand(const scene::Joint& joint, const JointLimits& limits, double q, double qd,
                double share, double dt);
  /// Records the result of the step: the `effort` that the solver applied [N m|N] for `demand`, and
  /// the position `q` and velocity `qd` that the joint reached. The servo detects saturation and
  /// stalls from them.
  void settle(const Demand& demand, const JointLimits& limits, double effort, double q, double qd,
              double dt);
  /// Closes the valve at once and clears the held position. Call it for a joint that its brake
  /// holds.
  void rest();
  /// Returns true if the joint has been stalled for longer than kStallTime.
  bool stalled() const { return stall_time_ > kStallTime; }

  /// Saves, loads or hashes the command, the valve and the stall time.
  void visit(Archive& a);

 private:
  /// Shortest stall that is reported [s]. Shorter ones are transients of the solver.
  static constexpr double kStallTime = 0.05;
  /// Returns true if the current command mode moves the valve.
  bool has_valve() const {
    return input_.mode != JointMode::kFree && input_.mode != JointMode::kEffort;
  }
  /// Returns the velocity towards the target [rad/s|m/s], before the delay of the valve.
  double wanted_speed(const scene::Joint& joint, const JointLimits& limits, double q,
                      double dt) const;

  /// Current command.
  JointInput input_;
  /// Opening of the valve, given as the velocity that it passes with enough oil [rad/s|m/s].
  double velocity_ = 0;
  /// Position to hold in modes other than kPosition [rad|m], valid while `holding_`.
  double held_ = 0;
  /// Velocity towards the target in the last step, before the delay of the valve [rad/s|m/s].
  double wanted_ = 0;
  /// Share (0 to 1) of the oil passed by its valve that the joint's cylinder got in the last step.
  double share_ = 1;
  /// Time for which the joint has been stalled [s].
  double stall_time_ = 0;
  /// `saturated_`: the last step reached a limit of effort. `holding_`: `held_` is valid.
  bool saturated_ = false, holding_ = false;
  /// True if the last open() left the valve clearly open.
  bool flows_ = false;
};

}  // namespace navvy::vehicle
