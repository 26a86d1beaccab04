// SPDX-License-Identifier: Apache-2.0
#include "control/tip_path.h"

#include <algorithm>
#include <cmath>

#include "control/dig_pose.h"

namespace navvy::control {
namespace {

// Lag of the tip behind its path at which the path waits [m]. The servo's own lag does not count:
// targets are ahead of the path by it.
constexpr double kLag = 0.2;
// Time by which a position servo follows behind a moving target [s]: its gain is 20 /s; and the
// time over which rates are smoothed [s].
constexpr double kServoLag = 0.05, kRateTime = 0.1;
// Speed below which a waiting tip counts as held by the soil [m/s].
constexpr double kHeld = 0.08;
constexpr double kGiveIn = 0.2;  // [s] of being held before the path rises
// Speed at which the path rises while held, and returns when free [m/s].
constexpr double kLiftRate = 0.3, kSinkRate = 0.1;
// Share of a cylinder's force from which on the path slows down, to a share of its speed at the
// whole force.
constexpr double kStrained = 0.8, kSlowest = 0.3;
// Share from which on a path that creeps rises before the machine stalls.
constexpr double kNearStall = 0.95;
// Feedback of the edge's height: rate [1/s], direct share, limit of the correction [m], and of its
// speed [m/s].
constexpr double kTrimRate = 3, kTrimShare = 0.4, kMostTrim = 0.08, kTrimSpeed = 0.4;
// A nose that rises by more than this angle [rad] is let down at this speed [m/s]: 5 deg/s, with
// the edge some 6 m ahead of the axle about which the machine turns. tuned: digging up a slope of
// 12 deg in loam the nose rises by 2.8 deg at most.
constexpr double kRise = radians(1.5), kRiseMost = radians(2.5), kReliefRate = 0.5;

}  // namespace

TipPath::Solution TipPath::solve(const OperatorContext& place, const Stance& stance, const Vec2& p,
                                 double height) const {
  const SwingPoint tip = swing_point(stance.swing_frame(*place.arm), Vec3(p.x(), p.y(), height));
  BucketPose pose{tip.reach, tip.height, tip.level(angle)};
  // Out of reach, the arm keeps its angles.
  ArmAngles q = place.arm_angles();
  const bool found = place.arm->inverse_nearest(pose, q);
  const double swing =
      place.handover.q[0] + std::remainder(tip.swing - place.handover.q[0], 2 * kPi);
  return {with_arm(swing, q), pose.angle + tip.pitch, found};
}

Axes TipPath::start(const OperatorContext& place, const Stance& stance, const Vec2& p,
                    double height, double tip_angle) {
  z = height;
  angle = tip_angle;
  lift = 0;
  slow = 1;
  stall_ = trim_ = trim_sum_ = 0;
  rate_ = {};
  const Solution solution = solve(place, stance, p, z);
  reached = solution.angle;
  return solution.q;
}

void TipPath::follow(OperatorContext& place, const Stance& stance, const Vec2& p,
                     const Observation& seen, double dt, Part part, Command& out) {
  if (part == Part::kAlong) keep_level(place, seen, dt);
  // Out of reach, `reached` keeps its last value.
  const Solution solution = solve(place, stance, p, z + lift + trim_);
  if (solution.found) reached = solution.angle;
  Axes& q = place.handover.q;
  for (std::size_t i = 0; i < 4; ++i) {
    // The servo gets no jumps, whatever the machine's pose or an arm limit did.
    const double rate =
        1.5 * std::min(2.0, std::max(0.1, seen.joints[place.joint(i)].velocity_limit));
    const double step = std::clamp(solution.q[i] - q[i], -rate * dt, rate * dt);
    q[i] += step;
    rate_[i] += (step / dt - rate_[i]) * (1 - std::exp(-dt / kRateTime));
    out.joints[place.joint(i)] =
        vehicle::JointInput{vehicle::JointMode::kPosition, q[i] + kServoLag * rate_[i]};
  }
  feel_stall(place, stance, seen, dt, part == Part::kCurl);
}

void TipPath::keep_level(const OperatorContext& place, const Observation& seen, double dt) {
  const ArmKinematics& arm = *place.arm;
  ArmAngles q;
  for (std::size_t i = 0; i < 3; ++i) q[i] = seen.joints[place.joint(i + 1)].position;
  const BucketPose tip = arm.forward(q);
  const double swing = seen.joints[place.joint(0)].position;
  // The pose as it is, not the filtered one: a chassis that pitches by a quarter of a degree moves
  // the edge by 3 cm.
  const Vec3 p_W = seen.X_WB * arm.X_BS() *
                   Vec3(tip.reach * std::cos(swing), tip.reach * std::sin(swing), tip.height);
  const double error = std::clamp(z + lift - p_W.z(), -kMostTrim, kMostTrim);
  // A tip that soil or rock holds is not pressed on it.
  if (stall_ > 0) return;
  trim_sum_ = std::clamp(trim_sum_ + kTrimRate * error * dt, -kMostTrim, kMostTrim);
  const double wish = std::clamp(trim_sum_ + kTrimShare * error, -kMostTrim, kMostTrim);
  trim_ += std::clamp(wish - trim_, -kTrimSpeed * dt, kTrimSpeed * dt);
}

void TipPath::hand_over(OperatorContext& place) const {
  for (std::size_t i = 0; i < 4; ++i) place.handover.q[i] += kServoLag * rate_[i];
}

void TipPath::visit(Archive& a) {
  a("z", z);
  a("angle", angle);
  a("reached", reached);
  a("lift", lift);
  a("slow", slow);
  a("rate", rate_);
  a("stall", stall_);
  a("trim", trim_);
  a("trim_sum", trim_sum_);
}

void TipPath::feel_stall(const OperatorContext& place, const Stance& stance,
                         const Observation& seen, double dt, bool curling) {
  ArmAngles real, soon;
  bool stalled = false;
  double strain = 0;
  constexpr double kAhead = 0.01;  // [s]
  for (std::size_t i = 0; i < 3; ++i) {
    const vehicle::JointState& joint = seen.joints[place.joint(i + 1)];
    real[i] = joint.position;
    soon[i] = joint.position + kAhead * joint.velocity;
    stalled = stalled || joint.stalled;
    if (joint.effort_limit > 0)
      strain = std::max(strain, std::abs(joint.effort) / joint.effort_limit);
  }
  const ArmKinematics& arm = *place.arm;
  const BucketPose wanted = arm.forward(place.arm_angles()), tip = arm.forward(real),
                   next = arm.forward(soon);
  // Compute how far the tip lags behind what the arm could reach, and its speed, from two poses a
  // moment apart.
  const double lag = std::hypot(tip.reach - wanted.reach, tip.height - wanted.height);
  const double speed = std::hypot(next.reach - tip.reach, next.height - tip.height) / kAhead;
  const double steady = stance.tilt_factor(seen.X_WB);
  slow = std::min(steady, std::clamp(2 - 2 * lag / kLag, 0.0, 1.0));
  slow = std::min(slow, std::clamp((1 - strain) / (1 - kStrained), kSlowest, 1.0));
  // A lag alone may be the servo's; a tip that lags and hardly moves is held, and so is one that
  // takes nearly all of a cylinder's force.
  const bool held = (slow < 0.35 || stalled || strain > kNearStall) && speed < kHeld;
  stall_ = held ? stall_ + dt : std::max(0.0, stall_ - 2 * dt);
  // Heel or edge press on the ground and lift the nose: the path yields in proportion.
  const double rise = stance.rise(seen.X_WB, arm, seen.joints[place.joint(0)].position);
  const double relief = kReliefRate * std::clamp((rise - kRise) / (kRiseMost - kRise), 0.0, 1.0);
  // Rising helps against soil in front, but not while the curl pulls the machine over.
  const bool tipping = curling && steady < 1;
  const double rate = std::max(relief, held && !tipping && stall_ > kGiveIn ? kLiftRate : 0.0);
  lift += rate * dt;
  if (!held && !(rise > 0.5 * kRise)) lift = std::max(0.0, lift - kSinkRate * dt);
}

}  // namespace navvy::control
