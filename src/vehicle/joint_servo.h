// SPDX-License-Identifier: Apache-2.0
// Servo of a joint: computes the velocity that brings the joint to its target within its limits.
// Independent of any engine.
#pragma once

#include "core/archive.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Present limits of a joint, as magnitudes.
struct JointLimits {
  double effort_positive = 1e9, effort_negative = 1e9;  ///< [N m|N]
  double speed_positive = 1e9, speed_negative = 1e9;    ///< [rad/s|m/s]
  /// Inertia of everything that moves with the joint [kg m2|kg]; 0: unknown.
  double inertia = 0;

  /// Visits all limits.
  void visit(Archive& a);
};

/// Valve and controller: turns a command into a velocity that the actuator shall reach in this
/// step.
///
/// The valve opens fully within 0.15 s. Near its target a position servo slows down so that half
/// its effort can stop the load. At velocity zero it holds the position at which it stopped.
class JointServo {
 public:
  /// Motion that the solver shall reach in a step.
  struct Demand {
    /// Velocity to reach [rad/s|m/s].
    double velocity = 0;
    /// Signed limits of the effort [N m|N].
    double effort_low = 0, effort_high = 0;
    /// Effort to apply as it is (kEffort) [N m|N].
    double feed_forward = 0;
  };

  /// Sets the command. It holds until it is replaced.
  void set(const JointInput& input) { input_ = input; }
  /// Returns the present command.
  const JointInput& input() const { return input_; }

  /// Moves the valve towards the command. Call it once per step, before demand().
  /// @returns the velocity that the valve passes with enough oil; 0 in modes without a valve
  /// (kFree, kEffort).
  double open(const scene::Joint& joint, const JointLimits& limits, double q, double qd, double dt);
  /// Returns whether the last open() left the valve further open than a step's travel: it neither
  /// holds nor stalls.
  bool flows() const { return flows_; }
  /// Returns the motion of this step with `share` of the oil that the valve passes.
  Demand demand(const scene::Joint& joint, const JointLimits& limits, double q, double qd,
                double share, double dt);
  /// Records the result of the step: the effort applied and the velocity reached.
  void settle(const Demand& demand, const JointLimits& limits, double effort, double q, double qd,
              double dt);
  /// Closes the valve at once and clears the held position, for a joint held by its brake.
  void rest();
  /// Returns whether the joint has been stalled for longer than kStallTime.
  bool stalled() const { return stall_time_ > kStallTime; }

  /// Visits command, valve and stall time.
  void visit(Archive& a);

 private:
  static constexpr double kStallTime = 0.05;  // [s] Shorter stalls are the solver's own settling.
  /// Returns whether the present mode moves the valve.
  bool has_valve() const {
    return input_.mode != JointMode::kFree && input_.mode != JointMode::kEffort;
  }
  /// Returns the velocity towards the target, before the valve's delay.
  double wanted_speed(const scene::Joint& joint, const JointLimits& limits, double q,
                      double dt) const;

  JointInput input_;
  // Valve position, as the velocity asked for in the last step.
  double velocity_ = 0;
  // Position to hold under velocity commands.
  double held_ = 0;
  // Velocity before the valve, with all the oil it could take.
  double wanted_ = 0;
  // Share of that oil that the last step got.
  double share_ = 1;
  double stall_time_ = 0;
  bool saturated_ = false, holding_ = false;
  bool flows_ = false;
};

}  // namespace navvy::vehicle
