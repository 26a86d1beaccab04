// SPDX-License-Identifier: Apache-2.0
// The digging cycle: return, approach, penetrate, drag, curl, lift, swing, dump; and when the trench is done.
#include <algorithm>
#include <cmath>

#include "control/dig_pose.h"
#include "control/operator_state.h"
#include "core/log.h"

namespace navvy::control {
namespace {

// Of the heaped capacity, when the curl begins; the lip cuts on while it curls, which adds a tenth. Fuller buckets
// carry more (0.55: loads of 520 kg instead of 400), but drip on the way, and heaps that go up rub the trench's walls.
// tuned: on the trench, 0.45 / 0.50 lose 0.7 / 0.9 % on the way and over-dig 7.3 / 9.1 %; with half the patience for
// drips 0.45 / 0.50 / 0.55 lose 1.1 / 1.2 / 3.1 % and over-dig 7.3 / 8.1 / 9.9 %.
constexpr double kFill = 0.45;
constexpr double kLiftClear = 0.6;    // lowest point over the ground before the machine swings [m]
constexpr double kEmpty = 0.017;      // share of a full bucket: less counts as nothing
constexpr double kWorthwhile = 0.07;  // less makes an empty scoop
constexpr int kMostEmpty = 3;         // empty scoops in a row that end the dig
// What a heaped bucket loses by itself falls back into the trench: so much less [share] within so long [s], for at most
// so long after the lift [s]. Then a bucket with a fair load [share of a full one] swings more gently [share of the
// usual rate].
constexpr double kDrip = 0.001, kStill = 0.8, kDripPatience = 4;
constexpr double kHeavy = 0.3, kGently = 0.5;
constexpr double kDumpPatience = 3.0;  // [s] of shaking the bucket
constexpr double kEarly = 0.6;         // share of the opening after which an empty bucket may leave
constexpr double kShake = radians(7), kShakeRate = 2 * kPi * 1.2;  // [rad], [rad/s]
constexpr double kRest = 2.0;                                      // [s] for loose soil to come to rest before the end
constexpr int kMostCleanUps = 2;
constexpr double kCleanEnough = 0.02;   // share of the design volume that may stay on the floor
constexpr double kHeapRadius = 0.6;     // around the dump point [m]
constexpr double kArmAfterSwing = 0.4;  // on the way back the arm comes down after this share of the swing

/// Highest ground around a point [m].
double heap_height(const SurfaceView& surface, const Vec2& p) {
  double highest = surface.height(p.x(), p.y());
  for (int i = 0; i < 8; ++i)
    for (const double r : {0.5 * kHeapRadius, kHeapRadius}) {
      const double a = i * kPi / 4;
      highest = std::max(highest, surface.height(p.x() + r * std::cos(a), p.y() + r * std::sin(a)));
    }
  return highest;
}

/// What the operator looks at: the view given, or the resting ground.
template <class Use>
auto with_surface(const Observation& seen, Use use) {
  if (seen.surface) return use(*seen.surface);
  const GroundSurface resting(*seen.ground);
  return use(static_cast<const SurfaceView&>(resting));
}

}  // namespace

void Operator::State::begin_dig(const scene::Dig& dig, const Observation& seen) {
  smooth_base(seen, 0, true);
  for (int i = 0; i < 3; ++i) m.up[i] = seen.X_WB.linear()(i, 2);
  const heightfield::Ground& ground = *seen.ground;
  const Vec2 middle = 0.5 * (dig.from + dig.to);
  const Vec2i cell = ground.column_at(middle.x(), middle.y());
  const auto& soils = ground.setup().soils;
  const std::size_t kind = ground.contains(cell.x(), cell.y()) ? ground.surface_soil(cell.x(), cell.y()) : 0;
  const scene::Soil soil = kind < soils.size() ? soils[kind] : scene::Soil{};
  m.scoop_volume = kFill * arm->bucket().capacity / soil.swell;
  m.full_mass = m.scoop_volume * soil.bank_density;
  plan = with_surface(seen, [&](const SurfaceView& surface) {
    return DigPlan(dig, trench_line(dig, swing_frame()), m.scoop_volume, surface);
  });
  m.empty_scoops = 0;
  m.clean_ups = 0;
  m.first_cycle = m.cycles;
  m.begun = 1;
}

bool Operator::State::plan_scoop(const scene::Dig& dig, const Observation& seen) {
  if (m.cycles - m.first_cycle >= dig.max_cycles || m.empty_scoops >= kMostEmpty) return false;
  Scoop scoop = with_surface(seen, [&](const SurfaceView& surface) { return plan.next(surface); });
  m.cleaning = 0;
  if (!scoop.any && m.clean_ups < kMostCleanUps) {
    const double rest =
        with_surface(seen, [&](const SurfaceView& surface) { return plan.volume_above(surface, dig.depth); });
    if (rest > kCleanEnough * plan.design_volume()) {
      m.cleaning = 1;
      scoop = plan.clean_up();
    }
  }
  if (!scoop.any) return false;
  m.scoop_start = scoop.start;
  m.scoop_end = scoop.end;
  m.scoop_level = scoop.level;
  return true;
}

void Operator::State::go_to_scoop(Phase next, const Observation& seen) {
  m.s = m.scoop_start;
  const Vec2 p = plan.point(m.s);
  // While it swings back the bucket stays above the trench's edges and what was spilt on them; then it goes down.
  const double ground = with_surface(seen, [&](const SurfaceView& surface) {
    return next == Phase::kReturn ? plan.highest_beside(surface, m.s) : surface.height(p.x(), p.y());
  });
  m.z = std::max(ground, plan.start_height(m.s) - m.scoop_level) + kClear;
  m.angle = with_cut(*arm, kPlunge);
  const SwingPoint tip = swing_point(swing_frame(), Vec3(p.x(), p.y(), m.z));
  BucketPose pose{tip.reach, tip.height, tip.level(m.angle)};
  ArmAngles q = arm_now();
  arm->inverse_nearest(pose, q);
  m.reached = pose.angle + tip.pitch;
  m.lift = 0;
  m.stall = 0;
  m.slow = 1;
  m.held_since = 0;
  const double swing = m.q[0] + std::remainder(tip.swing - m.q[0], 2 * kPi);
  start_move(with_arm(swing, q), seen, {1.0, kArmAfterSwing});
  enter(next);
}

void Operator::State::start_lift(const Observation& seen) {
  const Vec2 p = plan.point(m.s);
  const double ground = with_surface(seen, [&](const SurfaceView& surface) { return surface.height(p.x(), p.y()); });
  const double z = std::max(ground, plan.start_height(m.s)) + kLiftClear + arm->below_tip(kCarry);
  const SwingPoint tip = swing_point(swing_frame(), Vec3(p.x(), p.y(), z));
  BucketPose carry{tip.reach, tip.height, tip.level(kCarry)};
  ArmAngles q = arm_now();
  arm->inverse_nearest(carry, q);
  start_move(with_arm(m.q[0], q), seen, {1.2, 0});
  enter(Phase::kLift);
}

bool Operator::State::drips(const Observation& seen) {
  if (m.held_since < move_time() || seen.payload < (1 - kDrip) * m.held) {
    m.held = seen.payload;
    m.held_since = m.phase_time;
  }
  return m.phase_time < std::min(m.held_since + kStill, move_time() + kDripPatience);
}

void Operator::State::start_swing(const scene::Dig& dig, const Observation& seen) {
  const double heap = with_surface(seen, [&](const SurfaceView& surface) { return heap_height(surface, dig.dump_at); });
  const SwingPoint over = swing_point(swing_frame(), Vec3(dig.dump_at.x(), dig.dump_at.y(), heap));
  ArmAngles q = arm_now();
  double clearance = 0;
  if (!dump_pose(*arm, swing_frame(), dig.dump_at, heap, dig.dump_height, q, clearance)) {
    log_warning("operator: the heap is too high to dump on it, dumping from where the bucket is");
    q = arm_now();
  }
  // The short way round; with limits the only way.
  const double swing = arm->swing_limited() ? over.swing : m.q[0] + std::remainder(over.swing - m.q[0], 2 * kPi);
  start_move(with_arm(swing, q), seen, {seen.payload > kHeavy * m.full_mass ? kGently : 1.0, 0});
  enter(Phase::kSwing);
}

void Operator::State::start_dump(const Observation& seen) {
  ArmAngles q = arm_now();
  const double angle = arm->forward(q).angle;
  q[2] = std::clamp(q[2] + std::remainder(kOpen - angle, 2 * kPi), arm->lower(2), arm->upper(2));
  start_move(with_arm(m.q[0], q), seen, {1.3, 0});
  enter(Phase::kDump);
}

bool Operator::State::dumped(const Observation& seen) const {
  return seen.payload < kEmpty * m.full_mass || m.phase_time > move_time() + kDumpPatience;
}

void Operator::State::shake(const Observation& seen) {
  // Sticky soil: a few strokes of the bucket cylinder, as every operator does.
  const double since = m.phase_time - move_time();
  if (since <= 0 || seen.payload < kEmpty * m.full_mass) return;
  const double stroke = kShake * std::sin(kShakeRate * since);
  m.q[3] = std::clamp(m.to[3] - std::abs(stroke), arm->lower(2), arm->upper(2));
}

void Operator::State::look_round(const Observation& seen) {
  // Bucket half closed, out of the way, while what is loose comes to rest.
  ArmAngles q = arm_now();
  q[2] = std::clamp(q[2] + std::remainder(-0.75 * kPi - arm->forward(q).angle, 2 * kPi), arm->lower(2), arm->upper(2));
  start_move(with_arm(m.q[0], q), seen, {1.0, 0});
  enter(Phase::kLook);
}

void Operator::State::go_on(const scene::Dig& dig, Phase next, const Observation& seen) {
  if (plan_scoop(dig, seen))
    go_to_scoop(next, seen);
  else
    look_round(seen);
}

bool Operator::State::end_cycle(const scene::Dig& dig, const Observation& seen) {
  // After a pause, look again: soil may have slid into the trench, or come to rest there.
  if (!move(seen) || m.phase_time < kRest) return false;
  if (plan_scoop(dig, seen)) {
    go_to_scoop(Phase::kReturn, seen);
    return false;
  }
  if (m.empty_scoops >= kMostEmpty) log_warning("operator: three empty scoops in a row, the dig ends");
  if (m.cycles - m.first_cycle >= dig.max_cycles)
    log_warning("operator: the dig ends after its largest number of cycles");
  return true;
}

bool Operator::State::run(const scene::Dig& step, const Observation& seen, double dt, Command&) {
  if (m.begun == 0) {
    begin_dig(step, seen);
    go_on(step, Phase::kReturn, seen);
  }
  smooth_base(seen, dt, false);
  switch (phase()) {
    case Phase::kReturn:
      if (!move(seen)) break;
      // What lay loose when the bucket left has come to rest by now.
      go_on(step, Phase::kApproach, seen);
      break;
    case Phase::kApproach:
      if (!move(seen)) break;
      enter(Phase::kPenetrate);
      m.clean_ups += m.cleaning;
      event = CycleEvent::kScoopStart;
      break;
    case Phase::kPenetrate:
      penetrate(seen, dt);
      break;
    case Phase::kDrag:
      if (drag(seen, dt)) enter(Phase::kCurl);
      break;
    case Phase::kCurl:
      if (curl(seen, dt)) start_lift(seen);
      break;
    case Phase::kLift:
      if (!move(seen) || drips(seen)) break;
      event = CycleEvent::kLiftOut;
      start_swing(step, seen);
      break;
    case Phase::kSwing:
      if (!move(seen)) break;
      m.empty_scoops = seen.payload < kWorthwhile * m.full_mass ? m.empty_scoops + 1 : 0;
      if (m.empty_scoops > 0 && m.cleaning == 0)
        with_surface(seen, [&](const SurfaceView& surface) { plan.refuse(surface, m.scoop_start); });
      event = CycleEvent::kDumpStart;
      start_dump(seen);
      break;
    case Phase::kDump: {
      // The bucket need not open all the way when it is empty before.
      const bool open = m.phase_time > move_time() || move(seen);
      const bool early = m.phase_time > kEarly * move_time() && seen.payload < kEmpty * m.full_mass;
      shake(seen);
      if (!early && (!open || !dumped(seen))) break;
      ++m.cycles;
      event = CycleEvent::kCycleEnd;
      go_on(step, Phase::kReturn, seen);
      break;
    }
    default:
      return end_cycle(step, seen);
  }
  return false;
}

}  // namespace navvy::control
