// SPDX-License-Identifier: Apache-2.0
#include "control/arm_move.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "control/dig_pose.h"
#include "control/profile.h"

namespace navvy::control {
namespace {

// Rates of an unhurried operator at the middle of a move [rad/s]: swing, boom, stick, bucket.
// Hydraulics may be slower.
constexpr double kRates[4] = {0.80, 0.45, 0.70, 1.5};
constexpr double kShareOfLimit = 0.85;  // of a joint's own speed limit
constexpr double kShortestMove = 0.4;   // [s]
constexpr double kArrived = 0.03;       // [rad]
// When a move's time is over, an arm at rest counts as arrived [s], [rad/s].
constexpr double kSettle = 0.3, kAtRest = 0.02;
constexpr double kPatience = 2.0;  // beyond a move's own time [s]
// Share of the swing motor's torque that a swing may take to accelerate; the rest is for slopes and
// for soil that the operator does not see.
constexpr double kSwingTorque = 0.9;
// Share of the opening in which the bucket accelerates, and brakes.
constexpr double kOpenRamp = 0.2;

/// Returns the rate at which an axis moves [rad/s].
double rate_of(const OperatorContext& place, std::size_t axis, double share,
               const Observation& seen) {
  const double possible = kShareOfLimit * seen.joints[place.joint(axis)].velocity_limit;
  const double usual = share * kRates[axis];
  return possible > 0 ? std::min(usual, possible) : usual;
}

/// Returns the rotation of the bucket from the arm angles `q` to the angle at which soil falls out
/// [rad], by the revolution that the cylinder can reach.
double opening(const ArmKinematics& arm, const ArmAngles& q) {
  return std::clamp(q[2] + std::remainder(kOpen - arm.forward(q).angle, 2 * kPi), arm.lower(2),
                    arm.upper(2)) -
         q[2];
}

}  // namespace

double swing_acceleration(const OperatorContext& place, const ArmAngles& q, double load,
                          const Observation& seen) {
  const double effort = seen.joints[place.joint(0)].effort_limit;
  return kSwingTorque * effort / std::max(1.0, place.arm->swing_inertia(q, load));
}

void ArmMove::start(const OperatorContext& place, const Axes& to, const Observation& seen,
                    Pace pace) {
  double time[4];
  for (std::size_t i = 0; i < 4; ++i) {
    from_[i] = place.handover.q[i];
    to_[i] = to[i];
    // The smooth profile is fastest at 1.5 times its mean.
    time[i] = std::max(kShortestMove,
                       1.5 * std::abs(to_[i] - from_[i]) / rate_of(place, i, pace.share, seen));
  }
  swing_ramp_ = 0;
  swing_at_ = pace.hold_swing ? -1 : 0;
  open_at_ = -1;
  open_time_ = open_by_ = 0;
  const double path = std::abs(to_[0] - from_[0]);
  // Without a torque, as for a kinematic joint, the usual rate decides.
  if (pace.swing_acceleration > 0 && path > 0) {
    const double possible = kShareOfLimit * seen.joints[place.joint(0)].velocity_limit;
    const double fastest =
        std::min(std::sqrt(path * pace.swing_acceleration), possible > 0 ? possible : kRates[0]);
    const double accelerate = fastest / pace.swing_acceleration;
    time[0] = std::max(kShortestMove, path / fastest + accelerate);
    swing_ramp_ = std::clamp(accelerate / time[0], 0.05, 0.5);
  }
  // Boom, stick and bucket share one duration, so a bucket that is level at both ends stays level
  // in between.
  swing_time_ = time[0];
  arm_time_ = std::max({time[1], time[2], time[3]});
  arm_delay_ = time[0] > kShortestMove ? pace.arm_delay * time[0] : 0;
}

void ArmMove::open_bucket(const OperatorContext& place, const Observation& seen) {
  // Only the bucket joint moves.
  ArmAngles q = place.arm_angles();
  q[2] += opening(*place.arm, q);
  start(place, with_arm(place.handover.q[0], q), seen, {1.3, 0});
}

void ArmMove::release_swing(double since) { swing_at_ = since; }

void ArmMove::open_on_the_way(const OperatorContext& place, const Observation& seen, double since) {
  open_at_ = since;
  open_by_ = opening(*place.arm, {to_[1], to_[2], to_[3]});
  open_time_ =
      std::max(kShortestMove, std::abs(open_by_) / (1 - kOpenRamp) / rate_of(place, 3, 1.3, seen));
}

void ArmMove::visit(Archive& a) {
  a("from", from_);
  a("to", to_);
  a("swing_time", swing_time_);
  a("arm_delay", arm_delay_);
  a("arm_time", arm_time_);
  a("swing_at", swing_at_);
  a("swing_ramp", swing_ramp_);
  a("open_at", open_at_);
  a("open_time", open_time_);
  a("open_by", open_by_);
}

double ArmMove::duration() const {
  return std::max({std::max(0.0, swing_at_) + swing_time_, arm_delay_ + arm_time_,
                   open_at_ < 0 ? 0 : open_at_ + open_time_});
}

Axes ArmMove::at(double since) const {
  const double turned = swing_at_ < 0 ? 0 : (since - swing_at_) / swing_time_;
  const double swing = swing_ramp_ > 0 ? ramp(turned, swing_ramp_) : smooth(turned),
               other = smooth((since - arm_delay_) / arm_time_);
  Axes q;
  for (std::size_t i = 0; i < 4; ++i)
    q[i] = from_[i] + (i == 0 ? swing : other) * (to_[i] - from_[i]);
  return q;
}

bool ArmMove::advance(OperatorContext& place, const Observation& seen, double since,
                      const char* phase) {
  place.handover.q = at(since);
  // Remaining distance to the target, over all four joints alike.
  double error = 0, speed = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == 3 && open_at_ >= 0)
      place.handover.q[i] += open_by_ * ramp((since - open_at_) / open_time_, kOpenRamp);
    const vehicle::JointState& joint = seen.joints[place.joint(i)];
    error = std::max(error, std::abs(target(i) - joint.position));
    speed = std::max(speed, std::abs(joint.velocity));
  }
  const double over = since - duration();
  if (over < 0) return false;
  // Heavy soil in the bucket can hold a joint slightly short for ever, so rest counts as arrival.
  if (error < kArrived || (over > kSettle && speed < kAtRest)) return true;
  if (over < kPatience) return false;
  place.warn(std::string(phase) + " ended " + std::to_string(error) + " rad short of its target");
  return true;
}

}  // namespace navvy::control
