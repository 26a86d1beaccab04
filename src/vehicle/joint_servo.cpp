// SPDX-License-Identifier: Apache-2.0
#include "vehicle/joint_servo.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

// [1/s] position error to speed; 50 ms is the bandwidth of a proportional valve (U).
constexpr double kGain = 20;
// [s] from closed to full flow (U: 0.1 to 0.2 for pilot-operated spools).
constexpr double kValveTime = 0.15;
// Share of its effort by which a joint plans to brake. A joint without limits turns on a ring and
// carries no weight; a joint with limits may have to hold its load as well.
constexpr double kBrakeShare = 0.5, kFreeBrakeShare = 0.75;
// Share of a limit: the solver stops within its residual, not at the last bit.
constexpr double kSaturated = 0.999;
// Share of the full flow; less only holds a joint in place.
constexpr double kHolds = 0.02;
// Smallest share of the oil asked for.
constexpr double kLeastShare = 0.01;

}  // namespace

// One law per mode; only positions need a braking distance.
double JointServo::wanted_speed(const scene::Joint& joint, const JointLimits& limits, double q,
                                double dt) const {
  double wanted = input_.target;
  // Share of the speed available here and now, which differs between up and down.
  if (input_.mode == JointMode::kOpening)
    wanted *= wanted > 0 ? limits.speed_positive : limits.speed_negative;
  if (input_.mode == JointMode::kPosition) {
    // A target beyond a stop is the stop: the servo brakes for it as for any other position.
    const double target =
        joint.has_limits ? std::clamp(input_.target, joint.lower, joint.upper) : input_.target;
    const double error = target - q,
                 speed_limit = error > 0 ? limits.speed_positive : limits.speed_negative;
    // Available deceleration: that of the closing valve, and a share of what the effort does to
    // the load.
    double brake = 0.4 * speed_limit / kValveTime;
    const double effort = std::min(limits.effort_positive, limits.effort_negative);
    const double part = joint.has_limits ? kBrakeShare : kFreeBrakeShare;
    if (limits.inertia > 0) brake = std::min(brake, part * effort / limits.inertia);
    // Far away the speed from which it can still stop, close by proportional to the error, and
    // stable in a long step.
    const double speed = std::min(std::min(kGain, 0.2 / dt) * std::abs(error),
                                  std::sqrt(2 * brake * std::abs(error)));
    wanted = std::copysign(speed, error);
  }
  return std::clamp(wanted, -limits.speed_negative, limits.speed_positive);
}

// Slews the valve towards the wanted speed.
double JointServo::open(const scene::Joint& joint, const JointLimits& limits, double q, double qd,
                        double dt) {
  flows_ = false;
  if (!has_valve()) return 0;
  wanted_ = wanted_speed(joint, limits, q, dt);
  // Against a load that it cannot move, the valve opens from the actual flow, of which it got a
  // share.
  const double from = saturated_
                          ? std::clamp(qd / share_, -limits.speed_negative, limits.speed_positive)
                          : velocity_;
  const double fastest = std::max(limits.speed_positive, limits.speed_negative),
               slew = dt / kValveTime * fastest;
  // The spool needs its own time, whatever is asked.
  velocity_ = std::clamp(wanted_, from - slew, from + slew);
  // A smaller opening is holding: hardly any oil, and no load for the pump.
  flows_ = std::abs(velocity_) > std::max(1.5 * slew, kHolds * fastest);
  return velocity_;
}

// Effort alone, or a velocity with limits of effort.
JointServo::Demand JointServo::demand(const scene::Joint& joint, const JointLimits& limits,
                                      double q, double qd, double share, double dt) {
  Demand out;
  if (!has_valve()) {
    // Only the friction of the bearing holds it.
    out.effort_low = -joint.friction;
    out.effort_high = joint.friction;
    if (input_.mode == JointMode::kEffort)
      out.feed_forward = std::clamp(input_.target, -limits.effort_negative, limits.effort_positive);
    velocity_ = qd;
    holding_ = false;
    return out;
  }
  share_ = std::max(share, kLeastShare);
  // Short of oil, all functions slow down by the same share; the valve stays open.
  const double flowing = share_ * velocity_;
  out.velocity = flowing;
  if (input_.mode != JointMode::kPosition) {
    // Zero velocity alone does not brake: drive back what solver errors and loads shift.
    if (!holding_ || saturated_) held_ = q;
    holding_ = true;
    held_ += flowing * dt;
    out.velocity += std::min(5.0, 0.2 / dt) * (held_ - q - flowing * dt);
  } else {
    holding_ = false;
  }
  // The row may use the full effort to reach that velocity.
  out.effort_low = -limits.effort_negative;
  out.effort_high = limits.effort_positive;
  return out;
}

// Detects saturation and stall from the effort applied.
void JointServo::settle(const Demand& demand, const JointLimits& limits, double effort, double q,
                        double qd, double dt) {
  (void)q;
  // At a limit the load moves the joint, and the valve follows the actual flow.
  saturated_ = has_valve() && (effort >= kSaturated * demand.effort_high ||
                               effort <= kSaturated * demand.effort_low);
  // Stalled: full effort in the commanded direction, and less than a tenth of the speed that its
  // oil allows.
  const double speed_limit = wanted_ > 0 ? limits.speed_positive : limits.speed_negative;
  const bool asked = std::abs(wanted_) > 0.02 * std::min(speed_limit, 1.0);
  const bool stuck = saturated_ && asked && effort * wanted_ > 0 &&
                     qd * wanted_ < 0.1 * share_ * wanted_ * wanted_;
  stall_time_ = stuck ? std::min(stall_time_ + dt, 10.0) : 0.0;
}

void JointServo::rest() {
  velocity_ = wanted_ = stall_time_ = 0;
  share_ = 1;
  saturated_ = holding_ = flows_ = false;
}

void JointLimits::visit(Archive& a) {
  a("effort_positive", effort_positive);
  a("effort_negative", effort_negative);
  a("speed_positive", speed_positive);
  a("speed_negative", speed_negative);
  a("inertia", inertia);
}

// Visits the command and everything the next step reads.
void JointServo::visit(Archive& a) {
  a("input", input_);
  a("velocity", velocity_);
  a("held", held_);
  a("wanted", wanted_);
  a("share", share_);
  a("stall_time", stall_time_);
  a("saturated", saturated_);
  a("holding", holding_);
  a("flows", flows_);
}

}  // namespace navvy::vehicle
