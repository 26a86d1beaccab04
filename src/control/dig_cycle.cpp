// SPDX-License-Identifier: Apache-2.0
// One digging cycle: return, approach, penetrate, drag, curl, lift, swing, dump.
#include <algorithm>
#include <cmath>

#include "control/operator_state.h"
#include "core/log.h"

namespace navvy::control {
namespace {

constexpr double kClear = 0.5;            // tip over the ground before it goes down [m]
constexpr double kDownSpeed = 0.5;        // penetrating [m/s]
constexpr double kDragSpeed = 0.7;        // [m/s]
constexpr double kCurlTime = 2.6;         // [s]
constexpr double kAttack = radians(18);   // cutting edge below the horizontal while dragging
constexpr double kCarry = -radians(178);  // pin to tip line while carrying: mouth up
constexpr double kOpen = -radians(35);    // while dumping
constexpr double kLag = 0.12;             // tip behind its path by more than this: the machine is at its limit [m]
constexpr double kLiftRate = 0.25;        // the path rises by this while it lags [m/s]
constexpr double kSinkRate = 0.05;        // and comes back by this when it follows [m/s]
constexpr double kFill = 0.95;            // bank volume of a scoop as a share of capacity / swell 1.25
constexpr double kEmptyPayload = 15;      // [kg]
constexpr double kDumpPatience = 3.0;     // [s]
constexpr int kMostEmpty = 3;             // empty scoops in a row that end the dig
constexpr double kPhaseLimit = 20;        // [s]

double turned(double angle, double from, double to, double t) {
  (void)angle;
  return from + (to - from) * t * t * (3 - 2 * t);
}

}  // namespace

double Operator::State::path_height(const Observation& seen, double reach, double level) const {
  return plan.start_height(reach) - level - swing_frame(seen).translation().z();
}

bool Operator::State::plan_scoop(const scene::Dig& dig, const Observation& seen) {
  const Scoop scoop = plan.next(*seen.ground);
  if (!scoop.any || m.cycles >= dig.max_cycles || m.empty_scoops >= kMostEmpty) return false;
  m.scoop_start = scoop.start;
  m.scoop_level = scoop.level;
  m.scoop_end = plan.fill_end(*seen.ground, scoop, kFill * arm->bucket().capacity / 1.25);
  return true;
}

void Operator::State::begin_scoop(const scene::Dig&, const Observation& seen) {
  BucketPose above{m.scoop_start, path_height(seen, m.scoop_start, 0) + kClear,
                   -kPi + kAttack - arm->cut_angle() + radians(25)};
  ArmAngles q;
  if (!arm->inverse_nearest(above, q)) q = {m.q[1], m.q[2], m.q[3]};
  m.reach = above.reach;
  m.height = above.height;
  m.angle = above.angle;
  start_move(with_arm(plan.line().swing, q), seen);
  enter(Phase::kApproach);
}

void Operator::State::follow_tip(const Observation& seen, double dt) {
  BucketPose pose{m.reach, m.height + m.lift, m.angle};
  ArmAngles q;
  if (arm->inverse_nearest(pose, q))
    for (std::size_t i = 0; i < 3; ++i) m.q[i + 1] = q[i];
  ArmAngles real;
  for (std::size_t i = 0; i < 3; ++i) real[i] = seen.joints[static_cast<std::size_t>(arm->joints()[i])].position;
  const BucketPose tip = arm->forward(real);
  const double lag = std::hypot(tip.reach - pose.reach, tip.height - pose.height);
  const bool late = lag > kLag;
  m.slow = std::clamp(2 - 2 * lag / kLag, 0.0, 1.0);
  m.lift = std::max(0.0, m.lift + dt * (late ? kLiftRate : -kSinkRate));
}

void Operator::State::penetrate(const Observation& seen, double dt) {
  const double goal = path_height(seen, m.reach, m.scoop_level);
  m.height = std::max(goal, m.height - kDownSpeed * m.slow * dt);
  follow_tip(seen, dt);
  if (m.height <= goal || m.lift > 0.15 || m.phase_time > kPhaseLimit) enter(Phase::kDrag);
}

void Operator::State::drag(const scene::Dig&, const Observation& seen, double dt) {
  m.reach -= kDragSpeed * m.slow * dt;
  m.height = path_height(seen, m.reach, m.scoop_level);
  // The edge meets the ground at the attack angle as soon as the arm allows.
  const double wish = -kPi + kAttack - arm->cut_angle();
  m.angle += std::clamp(wish - m.angle, -0.5 * dt, 0.5 * dt);
  follow_tip(seen, dt);
  if (m.reach <= m.scoop_end || m.phase_time > kPhaseLimit) {
    m.curl_from = m.angle;
    m.lift = 0;
    m.height = std::max(m.height, path_height(seen, m.reach, m.scoop_level));
    enter(Phase::kCurl);
  }
}

void Operator::State::curl(const scene::Dig& dig, const Observation& seen, double dt) {
  const double t = std::clamp(m.phase_time / kCurlTime, 0.0, 1.0);
  m.angle = turned(m.angle, m.curl_from, kCarry, t);
  // The tip leaves the ground straight up while the bucket turns, so the near wall stays.
  m.height = turned(m.height, path_height(seen, m.reach, m.scoop_level), path_height(seen, m.reach, 0) + 0.35, t);
  follow_tip(seen, dt);
  m.lift = 0;
  if (t >= 1) start_lift(dig, seen);
}

void Operator::State::start_lift(const scene::Dig& dig, const Observation& seen) {
  const double ground = path_height(seen, m.reach, 0);
  const double rise = ground + dig.dump_height + 0.9;
  BucketPose carry{m.reach, rise, kCarry};
  ArmAngles q{m.q[1], m.q[2], m.q[3]};
  arm->inverse_nearest(carry, q);
  start_move(with_arm(m.q[0], q), seen, 1.2);
  enter(Phase::kLift);
}

void Operator::State::start_swing(const scene::Dig& dig, const Observation& seen) {
  const Pose X_WS = swing_frame(seen);
  const double ground = seen.ground->sample(dig.dump_at.x(), dig.dump_at.y());
  const Vec3 p = X_WS.inverse() * Vec3(dig.dump_at.x(), dig.dump_at.y(), ground);
  const double reach = std::hypot(p.x(), p.y());
  double swing = std::atan2(p.y(), p.x());
  if (!arm->swing_limited())
    while (swing - m.q[0] > kPi) swing -= 2 * kPi;
  // The bucket's middle is over the point: pin one and a half tip lengths' cosine out; height over what lies there.
  BucketPose over{reach - 0.7, p.z() + dig.dump_height + 0.7, kCarry};
  ArmAngles q{m.q[1], m.q[2], m.q[3]};
  arm->inverse_nearest(over, q);
  start_move(with_arm(swing, q), seen);
  enter(Phase::kSwing);
}

void Operator::State::start_dump(const Observation& seen) {
  ArmAngles q{m.q[1], m.q[2], m.q[3]};
  const BucketPose now = arm->forward(q);
  const double open = now.angle < -kPi ? kOpen - 2 * kPi : kOpen;
  q[2] = std::clamp(q[2] + (open - now.angle), arm->lower(2), arm->upper(2));
  start_move(with_arm(m.q[0], q), seen, 1.3);
  enter(Phase::kDump);
}

bool Operator::State::dumped(const Observation& seen) const {
  return seen.payload < kEmptyPayload || m.phase_time > m.duration + kDumpPatience;
}

bool Operator::State::run(const scene::Dig& step, const Observation& seen, double dt, Command& out) {
  (void)out;
  if (m.begun == 0) {
    plan = DigPlan(step, trench_line(step, swing_frame(seen)), *seen.ground);
    m.begun = 1;
    m.empty_scoops = 0;
    enter(Phase::kReturn);
    start_move({plan.line().swing, m.q[1], m.q[2], m.q[3]}, seen);
  }
  switch (phase()) {
    case Phase::kReturn:
      if (!move(seen)) break;
      if (!plan_scoop(step, seen)) return true;
      begin_scoop(step, seen);
      break;
    case Phase::kApproach:
      if (!move(seen)) break;
      m.lift = 0;
      m.slow = 1;
      enter(Phase::kPenetrate);
      event = CycleEvent::kScoopStart;
      break;
    case Phase::kPenetrate:
      penetrate(seen, dt);
      break;
    case Phase::kDrag:
      drag(step, seen, dt);
      break;
    case Phase::kCurl:
      curl(step, seen, dt);
      break;
    case Phase::kLift:
      if (!move(seen)) break;
      event = CycleEvent::kLiftOut;
      start_swing(step, seen);
      break;
    case Phase::kSwing:
      if (!move(seen)) break;
      m.empty_scoops = seen.payload < 40 ? m.empty_scoops + 1 : 0;
      event = CycleEvent::kDumpStart;
      start_dump(seen);
      break;
    case Phase::kDump:
      if (!move(seen) || !dumped(seen)) break;
      ++m.cycles;
      event = CycleEvent::kCycleEnd;
      enter(Phase::kReturn);
      start_move({plan.line().swing, m.q[1], m.q[2], m.q[3]}, seen);
      break;
    default:
      enter(Phase::kReturn);
      break;
  }
  return false;
}

}  // namespace navvy::control
