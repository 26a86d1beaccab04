// SPDX-License-Identifier: Apache-2.0
// What velocity a joint's servo asks for, so that it stops where it is told within its limits.
// Knows no engine.
#pragma once

#include "core/archive.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Present bounds of a joint; magnitudes.
struct JointLimits {
  double effort_positive = 1e9, effort_negative = 1e9;  ///< [N m|N]
  double speed_positive = 1e9, speed_negative = 1e9;    ///< [rad/s|m/s]
  /// Of all that hangs on the joint, 0: unknown [kg m2|kg].
  double inertia = 0;

  void visit(Archive& a);
};

/// A valve and its controller: turns a command into a velocity that the actuator is to reach in
/// this step.
///
/// The valve opens fully within 0.15 s; near its target a position servo slows down so that half
/// its effort can stop the load. With velocity zero it holds the place it stopped at.
class JointServo {
 public:
  struct Demand {
    double velocity = 0;                     ///< to reach [rad/s|m/s]
    double effort_low = 0, effort_high = 0;  ///< bounds of the effort, signed [N m|N]
    double feed_forward = 0;                 ///< effort to apply as it is (kEffort) [N m|N]
  };

  void set(const JointInput& input) { input_ = input; }
  const JointInput& input() const { return input_; }

  /// Turns the valve towards what the command asks for; call it once a step, before demand().
  /// @returns the velocity it lets through when there is oil enough; 0 where no valve is at work
  /// (kFree, kEffort).
  double open(const scene::Joint& joint, const JointLimits& limits, double q, double qd, double dt);
  /// The valve is open farther than a step's travel from closed: it neither holds nor stalls. Of
  /// the last open().
  bool flows() const { return flows_; }
  /// What the joint is to do in this step with `share` of the oil that its valve lets through.
  Demand demand(const scene::Joint& joint, const JointLimits& limits, double q, double qd,
                double share, double dt);
  /// Tells what came of it: effort applied and velocity reached.
  void settle(const Demand& demand, const JointLimits& limits, double effort, double q, double qd,
              double dt);
  /// A brake has the joint: the valve closes at once, and forgets what it held.
  void rest();
  bool stalled() const { return stall_time_ > kStallTime; }

  void visit(Archive& a);

 private:
  static constexpr double kStallTime = 0.05;  // [s] shorter is the solver's own settling
  bool has_valve() const {
    return input_.mode != JointMode::kFree && input_.mode != JointMode::kEffort;
  }
  double wanted_speed(const scene::Joint& joint, const JointLimits& limits, double q,
                      double dt) const;

  JointInput input_;
  double velocity_ = 0;  // valve position, as velocity asked for in the last step
  double held_ = 0;      // where the joint is to be by velocity commands
  double wanted_ = 0;    // before the valve, with all the oil it could take
  double share_ = 1;     // of that oil which the last step got
  double stall_time_ = 0;
  bool saturated_ = false, holding_ = false;
  bool flows_ = false;
};

}  // namespace navvy::vehicle
