// SPDX-License-Identifier: Apache-2.0
// The digging cycle: return, approach, penetrate, drag, curl, lift, swing, dump; and the conditions
// that end it.
#include "control/activities/dig/digging.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "control/dig_pose.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// Share of the heaped capacity at which the curl begins; the edge cuts on while it curls, which
// adds a tenth. Fuller buckets carry more (0.55: loads of 520 kg instead of 400), but spill during
// the swing, and higher heaps rub the trench's walls. tuned: on the trench, 0.45 / 0.50 lose 0.7 /
// 0.9 % during the swing and over-dig 7.3 / 9.1 %; with half the patience for drips 0.45 / 0.50 /
// 0.55 lose 1.1 / 1.2 / 3.1 % and over-dig 7.3 / 8.1 / 9.9 %.
constexpr double kFill = 0.45;
constexpr double kLiftClear = 0.6;  // lowest point over the ground before the machine swings [m]
// Share of a slice: when the drag was raised by more on average, the next slice is thinner.
constexpr double kHeldUp = 0.4;
constexpr double kEmpty = 0.017;      // share of a full bucket: less counts as nothing
constexpr double kWorthwhile = 0.07;  // less makes an empty scoop
// On the last floor a scoop that brings less is not repeated: a high wall sheds as much again and
// again.
constexpr double kLooseParticles = 0.15;
constexpr int kMostEmpty = 3;  // empty scoops in a row that end the dig
// Soil that a heaped bucket loses by itself falls back into the trench: wait while it loses this
// [share] within this time [s], for at most this long after the lift [s]. A bucket with a fair load
// [share of a full one] then swings more gently [share of the usual rate].
constexpr double kDrip = 0.001, kStill = 0.8, kDripPatience = 4;
constexpr double kHeavy = 0.3, kGently = 0.5;
constexpr double kDumpPatience = 3.0;  // [s] of shaking the bucket
constexpr double kEarly = 0.6;         // share of the opening after which an empty bucket may leave
constexpr double kShake = radians(7), kShakeRate = 2 * kPi * 1.2;  // [rad], [rad/s]
// A scoop's start may be this far out of reach [m]; drives end 0.15 m off.
constexpr double kBeyond = 0.3;
constexpr double kRest = 2.0;    // [s] for loose soil to come to rest before the end
constexpr int kMostCycles = 60;  // of a dig that was ordered no number of them
// Share of the design volume: with more left, a trench is not done
// [docs/validation.md, whole digs].
constexpr double kUndone = 0.15;
constexpr int kMostCleanUps = 2;
constexpr double kCleanEnough = 0.02;  // share of the design volume that may stay on the floor
constexpr double kHeapRadius = 0.6;    // around the dump point [m]
// During the return swing the arm comes down after this share of the swing.
constexpr double kArmAfterSwing = 0.4;

/// Returns the highest ground around a point [m].
double heap_height(const SurfaceView& surface, const Vec2& p) {
  double highest = surface.height(p.x(), p.y());
  for (int i = 0; i < 8; ++i)
    for (const double r : {0.5 * kHeapRadius, kHeapRadius}) {
      const double a = i * kPi / 4;
      highest = std::max(highest, surface.height(p.x() + r * std::cos(a), p.y() + r * std::sin(a)));
    }
  return highest;
}

/// Returns the surface that the operator sees: the view given, or the resting ground.
template <class Use>
auto with_surface(const Observation& seen, Use use) {
  if (seen.surface) return use(*seen.surface);
  const GroundSurfaceView resting(*seen.ground);
  return use(static_cast<const SurfaceView&>(resting));
}

}  // namespace

void Digging::begin(const Observation& seen) {
  m.stance.begin(seen.X_WB);
  const heightfield::Ground& ground = *seen.ground;
  // The soil at the trench's middle decides the mass of a full bucket.
  const Vec2 middle = 0.5 * (dig_.from + dig_.to);
  const Vec2i cell = ground.column_at(middle.x(), middle.y());
  const auto& soils = ground.setup().soils;
  const std::size_t kind =
      ground.contains(cell.x(), cell.y()) ? ground.surface_soil(cell.x(), cell.y()) : 0;
  const scene::Soil soil = kind < soils.size() ? soils[kind] : scene::Soil{};
  m.scoop_volume = kFill * arm_.bucket().capacity / soil.swell;
  m.full_mass = m.scoop_volume * soil.bank_density;
  plan_ = with_surface(seen, [&](const SurfaceView& surface) {
    return DigPlan(dig_, trench_line(dig_, m.stance.swing_frame(arm_)), m.scoop_volume, surface);
  });
  // Cycles count over the whole program, limits over this dig.
  m.first_cycle = place_.handover.cycles;
  go_on(kReturn, seen);
}

bool Digging::plan_scoop(const Observation& seen) {
  // Both limits end the dig whatever the plan still sees.
  if (cycles() >= dig_.max_cycles.value_or(kMostCycles) || m.empty_scoops >= kMostEmpty)
    return false;
  Scoop scoop = with_surface(seen, [&](const SurfaceView& surface) { return plan_.next(surface); });
  m.cleaning = 0;
  // Soil that fell back is spread along the whole floor, too thin for a scoop of the plan; one or
  // two passes clean it up.
  if (!scoop.any && m.clean_ups < kMostCleanUps) {
    const double rest = with_surface(
        seen, [&](const SurfaceView& surface) { return plan_.volume_above(surface, dig_.depth); });
    if (rest > kCleanEnough * plan_.design_volume()) {
      m.cleaning = 1;
      scoop = plan_.clean_up();
    }
  }
  if (!scoop.any || beyond_reach(scoop)) return false;
  m.scoop_start = scoop.start;
  m.soil_start = scoop.soil;
  m.scoop_end = scoop.end;
  m.scoop_level = scoop.level;
  return true;
}

bool Digging::beyond_reach(const Scoop& scoop) const {
  const Vec2 p = plan_.point(scoop.start);
  const SwingPoint at =
      swing_point(m.stance.swing_frame(arm_),
                  Vec3(p.x(), p.y(), plan_.start_height(scoop.start) - scoop.level));
  // A position nearer or farther by the tolerance would do.
  for (const double off : {0.0, -kBeyond, kBeyond}) {
    BucketPose pose{at.reach + off, at.height, at.level(with_cut(arm_, kPlunge))};
    ArmAngles q = place_.arm_angles();
    if (arm_.inverse_nearest(pose, q)) return false;
  }
  return true;
}

void Digging::go_to_scoop(Phase next, const Observation& seen) {
  m.s = m.scoop_start;
  const Vec2 p = plan_.point(m.s);
  // During the return swing the bucket stays above the trench's edges and the soil spilt on them;
  // then it goes down.
  const double ground = with_surface(seen, [&](const SurfaceView& surface) {
    return next == kReturn ? plan_.highest_beside(surface, m.s) : surface.height(p.x(), p.y());
  });
  const double z = std::max(ground, plan_.start_height(m.s) - m.scoop_level) + kClear;
  m.held_since = 0;
  m.move.start(place_, m.tip.start(place_, m.stance, p, z, with_cut(arm_, kPlunge)), seen,
               {1.0, kArmAfterSwing});
  enter(next);
}

void Digging::start_lift(const Observation& seen) {
  const Vec2 p = plan_.point(m.s);
  const double ground =
      with_surface(seen, [&](const SurfaceView& surface) { return surface.height(p.x(), p.y()); });
  // The lowest part of the level bucket clears the ground, not its tip.
  const double z = std::max(ground, plan_.start_height(m.s)) + kLiftClear + arm_.below_tip(kCarry);
  const SwingPoint tip = swing_point(m.stance.swing_frame(arm_), Vec3(p.x(), p.y(), z));
  BucketPose carry{tip.reach, tip.height, tip.level(kCarry)};
  ArmAngles q = place_.arm_angles();
  arm_.inverse_nearest(carry, q);
  m.move.start(place_, with_arm(place_.handover.q[0], q), seen, {1.2, 0});
  enter(kLift);
}

bool Digging::drips(const Observation& seen) {
  // Every loss restarts the clock; before the arm has lifted there is nothing to judge.
  if (m.held_since < m.move.duration() || seen.payload < (1 - kDrip) * m.held) {
    m.held = seen.payload;
    m.held_since = phase_time();
  }
  return phase_time() < std::min(m.held_since + kStill, m.move.duration() + kDripPatience);
}

void Digging::start_swing(const Observation& seen) {
  // The heap grows from cycle to cycle: the bucket opens over its present height.
  const double heap = with_surface(
      seen, [&](const SurfaceView& surface) { return heap_height(surface, dig_.dump_at); });
  const SwingPoint over =
      swing_point(m.stance.swing_frame(arm_), Vec3(dig_.dump_at.x(), dig_.dump_at.y(), heap));
  ArmAngles q = place_.arm_angles();
  double clearance = 0;
  if (!dump_pose(arm_, m.stance.swing_frame(arm_), dig_.dump_at, heap, dig_.dump_height, q,
                 clearance)) {
    place_.warn("the heap is too high to dump on it, dumping from where the bucket is");
    q = place_.arm_angles();
  }
  // Take the shorter arc; with limits, the only one.
  const double swing =
      arm_.swing_limited()
          ? over.swing
          : place_.handover.q[0] + std::remainder(over.swing - place_.handover.q[0], 2 * kPi);
  m.move.start(place_, with_arm(swing, q), seen,
               {seen.payload > kHeavy * m.full_mass ? kGently : 1.0, 0});
  enter(kSwing);
}

void Digging::start_dump(const Observation& seen) {
  m.move.open_bucket(place_, seen);
  landing_.start(seen);
  enter(kDump);
}

void Digging::thin_slices() {
  // A boulder raises the path for a part of the drag, soil that is too strong for all of it.
  if (m.cleaning != 0 || m.held_up <= kHeldUp * plan_.slice() * (m.scoop_start - m.s)) return;
  if (plan_.thin())
    place_.warn("the soil holds the bucket: slices of " + metres(plan_.slice()) + " from now on");
}

bool Digging::dump(const Observation& seen) {
  // After the opening the shaking controls the bucket's joint: the move must not take it back.
  const bool open = phase_time() > m.move.duration() || move(seen);
  const bool empty = seen.payload < kEmpty * m.full_mass;
  shake(seen);
  // The bucket need not open fully when it is empty before.
  if (empty && phase_time() > kEarly * m.move.duration()) return true;
  return open && (empty || phase_time() > m.move.duration() + kDumpPatience);
}

void Digging::shake(const Observation& seen) {
  // Sticky soil: a few strokes of the bucket cylinder, as every operator does.
  const double since = phase_time() - m.move.duration();
  if (since <= 0 || seen.payload < kEmpty * m.full_mass) return;
  const double stroke = kShake * std::sin(kShakeRate * since);
  place_.handover.q[3] =
      std::clamp(m.move.target(3) - std::abs(stroke), arm_.lower(2), arm_.upper(2));
}

void Digging::look_round(const Observation& seen) {
  // Bucket half closed and aside, while loose soil comes to rest.
  ArmAngles q = place_.arm_angles();
  q[2] = std::clamp(q[2] + std::remainder(-0.75 * kPi - arm_.forward(q).angle, 2 * kPi),
                    arm_.lower(2), arm_.upper(2));
  m.move.start(place_, with_arm(place_.handover.q[0], q), seen, {1.0, 0});
  enter(kLook);
}

void Digging::go_on(Phase next, const Observation& seen) {
  if (plan_scoop(seen))
    go_to_scoop(next, seen);
  else
    look_round(seen);
}

bool Digging::end_cycle(const Observation& seen) {
  // After a pause, look again: soil may have slid into the trench, or come to rest there.
  if (!move(seen) || phase_time() < kRest) return false;
  if (falls_short_of_receiver(seen)) return true;
  if (plan_scoop(seen)) {
    go_to_scoop(kReturn, seen);
    return false;
  }
  return conclude(seen);
}

bool Digging::falls_short_of_receiver(const Observation& seen) {
  std::string shortfall = landing_.end(seen);
  return !shortfall.empty() && fall_short(StepState::kStalled, std::move(shortfall));
}

bool Digging::conclude(const Observation& seen) {
  const TrenchState now =
      with_surface(seen, [&](const SurfaceView& surface) { return plan_.state(surface); });
  const std::string left = number_text(now.left, "m3") + " of " +
                           number_text(plan_.design_volume(), "m3") +
                           " are left, half of the length is " + metres(now.depth) +
                           " deep or more of " + metres(dig_.depth);
  const bool undone = now.left > kUndone * plan_.design_volume();
  if (m.empty_scoops >= kMostEmpty && undone)
    return fall_short(StepState::kStalled,
                      "three empty scoops in a row: nothing more comes into the bucket; " + left);
  // A program that sets a number of cycles wants these, not the trench.
  if (dig_.max_cycles && cycles() >= *dig_.max_cycles) {
    remark("made its " + std::to_string(*dig_.max_cycles) + " cycles; " + left);
  } else if (const Scoop next =
                 with_surface(seen, [&](const SurfaceView& s) { return plan_.next(s); });
             next.any && beyond_reach(next)) {
    const Vec2 p = plan_.point(next.start);
    const SwingPoint at =
        swing_point(m.stance.swing_frame(arm_), Vec3(p.x(), p.y(), plan_.start_height(next.start)));
    return fall_short(StepState::kOutOfReach,
                      "the machine no longer stands where it began: the next scoop at " +
                          place_text(p) + " is " + metres(at.reach) +
                          " from the swing axis, out of the bucket's reach; " + left);
  } else if (undone && cycles() >= kMostCycles) {
    return fall_short(StepState::kOutOfTime,
                      "not done after " + std::to_string(kMostCycles) + " cycles; " + left);
  } else if (undone) {
    return fall_short(StepState::kBlocked, "what is left could not be dug; " + left);
  }
  return true;
}

std::vector<Measurement> Digging::account(const Observation& seen) const {
  const TrenchState now =
      with_surface(seen, [&](const SurfaceView& surface) { return plan_.state(surface); });
  std::vector<Measurement> out = {{"cycles", static_cast<double>(cycles())},
                                  {"design_volume_m3", plan_.design_volume()},
                                  {"volume_left_m3", now.left},
                                  {"depth_m", dig_.depth},
                                  {"depth_reached_m", now.depth}};
  const std::vector<Measurement> landed = landing_.account();
  out.insert(out.end(), landed.begin(), landed.end());
  return out;
}

// In the order of Phase.
const char* Digging::phase() const {
  static const char* const names[] = {"return", "approach", "penetrate", "drag", "curl",
                                      "lift",   "swing",    "dump",      "look"};
  return names[phase_index()];
}

bool Digging::update(const Observation& seen, double dt, Command&) {
  // Filtered in all phases, or the pose would jump when it is used again.
  m.stance.follow(seen.X_WB, dt);
  switch (phase_index()) {
    case kReturn:
      // Soil that was loose when the bucket left has come to rest by now.
      if (!move(seen)) break;
      if (falls_short_of_receiver(seen)) return true;
      go_on(kApproach, seen);
      break;
    case kApproach:
      if (!move(seen)) break;
      enter(kPenetrate);
      // What the ground under the wheels has done so far was not caused by the bucket.
      m.stance.settle();
      m.clean_ups += m.cleaning;
      tell(CycleEvent::kScoopStart);
      break;
    case kPenetrate:
      // Enters the drag itself: by depth, by stall, or by time.
      penetrate(seen, dt);
      break;
    case kDrag:
      if (!drag(seen, dt)) break;
      thin_slices();
      tell(CycleEvent::kCurlStart);
      enter(kCurl);
      break;
    case kCurl:
      if (curl(seen, dt)) start_lift(seen);
      break;
    case kLift:
      if (!move(seen) || drips(seen)) break;
      tell(CycleEvent::kLiftOut);
      start_swing(seen);
      break;
    case kSwing:
      if (!move(seen)) break;
      m.empty_scoops = seen.payload < kWorthwhile * m.full_mass ? m.empty_scoops + 1 : 0;
      // A pass along the whole floor may bring little; a scoop that does has met soil that cannot
      // be dug.
      if (m.cleaning == 0 &&
          seen.payload < (m.scoop_level < dig_.depth ? kWorthwhile : kLooseParticles) * m.full_mass)
        with_surface(seen,
                     [&](const SurfaceView& surface) { plan_.refuse(surface, m.soil_start); });
      tell(CycleEvent::kDumpStart);
      start_dump(seen);
      break;
    case kDump:
      if (!dump(seen)) break;
      ++place_.handover.cycles;
      // From here it is visible whether, and where, the next cycle begins.
      tell(CycleEvent::kCycleEnd);
      go_on(kReturn, seen);
      break;
    default:  // kLook
      return end_cycle(seen);
  }
  return false;
}

void DiggingMemory::visit(Archive& a) {
  a("move", move);
  a("stance", stance);
  a("tip", tip);
  a("first_cycle", first_cycle);
  a("empty_scoops", empty_scoops);
  a("clean_ups", clean_ups);
  a("cleaning", cleaning);
  a("scoop_start", scoop_start);
  a("soil_start", soil_start);
  a("scoop_end", scoop_end);
  a("scoop_level", scoop_level);
  a("s", s);
  a("progress", progress);
  a("curl_angle", curl_angle);
  a("curl_z", curl_z);
  a("scoop_volume", scoop_volume);
  a("full_mass", full_mass);
  a("lift_before", lift_before);
  a("held_up", held_up);
  a("held", held);
  a("held_since", held_since);
}

void Digging::visit(Archive& a) {
  ActivityWith::visit(a);
  // The phase indexes a table of names.
  a.require(phase_index() >= kReturn && phase_index() <= kLook, "phase", "no phase of a dig");
  a("plan", plan_);
  landing_.visit(a);
}

}  // namespace navvy::control
