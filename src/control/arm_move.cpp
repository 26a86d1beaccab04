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

}  // namespace

void ArmMove::start(const OperatorContext& place, const Axes& to, const Observation& seen,
                    Pace pace) {
  double time[4];
  for (std::size_t i = 0; i < 4; ++i) {
    from_[i] = place.handover.q[i];
    to_[i] = to[i];
    const double possible = kShareOfLimit * seen.joints[place.joint(i)].velocity_limit;
    const double rate =
        possible > 0 ? std::min(pace.share * kRates[i], possible) : pace.share * kRates[i];
    // The smooth profile is fastest at 1.5 times its mean.
    time[i] = std::max(kShortestMove, 1.5 * std::abs(to_[i] - from_[i]) / rate);
  }
  // Boom, stick and bucket share one duration, so a bucket that is level at both ends stays level
  // in between.
  swing_time_ = time[0];
  arm_time_ = std::max({time[1], time[2], time[3]});
  arm_delay_ = time[0] > kShortestMove ? pace.arm_delay * time[0] : 0;
}

void ArmMove::open_bucket(const OperatorContext& place, const Observation& seen) {
  const ArmKinematics& arm = *place.arm;
  // Choose the revolution of the opening angle that the cylinder can reach; only the bucket joint
  // moves.
  ArmAngles q = place.arm_angles();
  const double angle = arm.forward(q).angle;
  q[2] = std::clamp(q[2] + std::remainder(kOpen - angle, 2 * kPi), arm.lower(2), arm.upper(2));
  start(place, with_arm(place.handover.q[0], q), seen, {1.3, 0});
}

void ArmMove::visit(Archive& a) {
  a("from", from_);
  a("to", to_);
  a("swing_time", swing_time_);
  a("arm_delay", arm_delay_);
  a("arm_time", arm_time_);
}

double ArmMove::duration() const { return std::max(swing_time_, arm_delay_ + arm_time_); }

bool ArmMove::advance(OperatorContext& place, const Observation& seen, double since,
                      const char* phase) {
  const double swing = smooth(since / swing_time_),
               other = smooth((since - arm_delay_) / arm_time_);
  // Remaining distance to the target, over all four joints alike.
  double error = 0, speed = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    place.handover.q[i] = from_[i] + (i == 0 ? swing : other) * (to_[i] - from_[i]);
    const vehicle::JointState& joint = seen.joints[place.joint(i)];
    error = std::max(error, std::abs(to_[i] - joint.position));
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
