// SPDX-License-Identifier: Apache-2.0
// Tip paths of a scoop in the vertical plane of the trench: down, along, curl; and what happens when the arm stalls.
#include <algorithm>
#include <cmath>

#include "control/dig_pose.h"
#include "control/operator_state.h"
#include "core/log.h"

namespace navvy::control {
namespace {

constexpr double kDownAir = 0.9, kDownSoil = 0.45;  // [m/s]
constexpr double kDragSpeed = 0.7;                  // [m/s]
constexpr double kTurnIn = 0.9;                     // of the bucket while dragging [rad/s]
constexpr double kCurlTime = 2.2;                   // [s]
// The lip cuts on [m/s] in this first share of the curl, if the bucket has this share of a load; one with less only
// scrapes. Held by rock it stands still (m.slow). tuned: on the trench, 0.30 and 0.55 m/s keep 470 and 520 kg of 512.
constexpr double kCurlSpeed = 0.50, kCutOn = 0.6, kFair = 0.5;
constexpr double kOut = 0.25;      // lowest point over the surface after the curl [m]
constexpr double kPastEnd = 0.03;  // the shell may pass the far end by this [m]
constexpr double kMore = 0.5;      // the drag goes on by this beyond its planned end when the bucket is not full [m]
constexpr double kLag = 0.12;      // tip this far behind its path: the path waits [m]
constexpr double kHeld = 0.08;     // [m/s] a waiting tip slower than this is held by the soil
constexpr double kGiveIn = 0.2;    // [s] of being held before the path rises
constexpr double kLiftRate = 0.3, kSinkRate = 0.1;  // of the path while held, and back when free [m/s]
constexpr double kTilt = radians(1.5);              // the chassis moves on its tyres; at twice this the arm waits
constexpr double kPenetrateLift = 0.12;             // raised by so much on the way down: go on at that depth [m]
constexpr double kPhaseLimit = 12;                  // [s]
constexpr double kBaseTime = 0.25;                  // smoothing of the chassis' pose [s]

double smooth(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

void Operator::State::smooth_base(const Observation& seen, double dt, bool reset) {
  const Eigen::Quaterniond now(seen.X_WB.linear());
  Eigen::Quaterniond q(m.base[3], m.base[4], m.base[5], m.base[6]);
  const double share = reset ? 1.0 : 1 - std::exp(-dt / kBaseTime);
  q = reset ? now : q.slerp(share, now);
  for (int i = 0; i < 3; ++i) m.base[i] = mix(m.base[i], seen.X_WB.translation()[i], share);
  m.base[3] = q.w();
  m.base[4] = q.x();
  m.base[5] = q.y();
  m.base[6] = q.z();
}

Pose Operator::State::swing_frame() const {
  Pose X_WB = Pose::Identity();
  X_WB.linear() = Eigen::Quaterniond(m.base[3], m.base[4], m.base[5], m.base[6]).normalized().toRotationMatrix();
  X_WB.translation() = Vec3(m.base[0], m.base[1], m.base[2]);
  return X_WB * arm->X_BS();
}

bool Operator::State::overdue(double limit) const {
  if (m.phase_time <= limit) return false;
  log_warning("operator: " + phase_name + " took more than " + std::to_string(static_cast<int>(limit)) +
              " s, going on with the cycle");
  return true;
}

double Operator::State::floor_height() const {
  // The tip rides so high that no part of the bucket goes below the slice.
  return plan.start_height(m.s) - m.scoop_level + arm->below_tip(m.reached);
}

double Operator::State::footing(const Observation& seen) const {
  const double tilt = Vec3(m.up[0], m.up[1], m.up[2]).cross(Vec3(seen.X_WB.linear().col(2))).norm();
  return std::clamp(2 - tilt / kTilt, 0.0, 1.0);
}

void Operator::State::feel_stall(const Observation& seen, const BucketPose& wanted, double dt) {
  ArmAngles real, soon;
  bool stalled = false;
  constexpr double kAhead = 0.01;  // [s]
  for (std::size_t i = 0; i < 3; ++i) {
    const vehicle::JointState& joint = seen.joints[axis_joint(i + 1)];
    real[i] = joint.position;
    soon[i] = joint.position + kAhead * joint.velocity;
    stalled = stalled || joint.stalled;
  }
  const BucketPose tip = arm->forward(real), next = arm->forward(soon);
  const double lag = std::hypot(tip.reach - wanted.reach, tip.height - wanted.height);
  const double speed = std::hypot(next.reach - tip.reach, next.height - tip.height) / kAhead;
  m.slow = std::min(footing(seen), std::clamp(2 - 2 * lag / kLag, 0.0, 1.0));
  const bool held = (m.slow < 0.35 || stalled) && speed < kHeld;
  m.stall = held ? m.stall + dt : std::max(0.0, m.stall - 2 * dt);
  // Rising helps against soil in front, but not while the curl pulls the machine over.
  const bool tipping = phase() == Phase::kCurl && footing(seen) < 1;
  if (held && !tipping && m.stall > kGiveIn) m.lift += kLiftRate * dt;
  if (!held) m.lift = std::max(0.0, m.lift - kSinkRate * dt);
}

void Operator::State::follow_tip(const Observation& seen, double dt) {
  const Vec2 p = plan.point(m.s);
  const SwingPoint tip = swing_point(swing_frame(), Vec3(p.x(), p.y(), m.z + m.lift));
  BucketPose pose{tip.reach, tip.height, tip.level(m.angle)};
  ArmAngles q = arm_now();
  if (arm->inverse_nearest(pose, q)) m.reached = pose.angle + tip.pitch;
  const double swing = m.q[0] + std::remainder(tip.swing - m.q[0], 2 * kPi);
  const std::array<double, 4> to = with_arm(swing, q);
  for (std::size_t i = 0; i < 4; ++i) {
    // The servo gets no jumps, whatever the pose of the machine or a limit of the arm did.
    const double rate = 1.5 * std::min(2.0, std::max(0.1, seen.joints[axis_joint(i)].velocity_limit));
    m.q[i] += std::clamp(to[i] - m.q[i], -rate * dt, rate * dt);
  }
  feel_stall(seen, arm->forward(arm_now()), dt);
}

void Operator::State::penetrate(const Observation& seen, double dt) {
  const bool in_air = m.z > plan.start_height(m.s) + 0.1;
  const double goal = floor_height();
  m.z = std::max(goal, m.z - (in_air ? kDownAir : kDownSoil) * m.slow * dt);
  follow_tip(seen, dt);
  if (m.z <= goal || m.lift > kPenetrateLift || overdue(kPhaseLimit)) enter(Phase::kDrag);
}

bool Operator::State::drag(const Observation& seen, double dt) {
  m.s = std::max(0.0, m.s - kDragSpeed * m.slow * dt);
  // The bucket turns in to its digging angle as soon as its back stays clear of the far end.
  const double wish = with_cut(*arm, -kPi + kAttack), turned = std::max(wish, m.angle - kTurnIn * m.slow * dt);
  const double depth = plan.start_height(m.s) - m.z - m.lift;
  if (plan.length() - m.s + kPastEnd >= arm->beyond_tip(turned, depth)) m.angle = turned;
  m.z = std::max(floor_height(), m.z - kDownSoil * m.slow * dt);
  follow_tip(seen, dt);
  const bool full = seen.payload >= m.full_mass;
  const bool planned = m.s <= m.scoop_end && (seen.payload > 0.8 * m.full_mass || m.s <= m.scoop_end - kMore);
  if (!(full || planned || m.s <= 0 || overdue(kPhaseLimit))) return false;
  m.curl_angle = m.angle = m.reached;
  m.curl_z = m.z = m.z + m.lift;
  m.lift = 0;
  m.progress = 0;
  return true;
}

bool Operator::State::curl(const Observation& seen, double dt) {
  const double least = footing(seen) < 1 ? 0 : 0.1;
  m.progress = std::min(1.0, m.progress + std::max(least, m.slow) * dt / kCurlTime);
  if (m.progress < kCutOn && seen.payload > kFair * m.full_mass) m.s = std::max(0.0, m.s - kCurlSpeed * m.slow * dt);
  m.angle = mix(m.curl_angle, kCarry, smooth(m.progress / 0.8));
  // First the bucket turns, its heel on the slice's floor; then it leaves the ground straight up.
  const double top = plan.start_height(m.s) + kOut + arm->below_tip(m.reached);
  m.z = mix(std::max(m.curl_z, floor_height()), top, smooth((m.progress - 0.35) / 0.65));
  follow_tip(seen, dt);
  return m.progress >= 1 || overdue(kPhaseLimit);
}

}  // namespace navvy::control
