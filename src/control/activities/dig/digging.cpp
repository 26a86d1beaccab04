// SPDX-License-Identifier: Apache-2.0
// The digging cycle: return, approach, penetrate, drag, curl, lift, swing, dump; and the conditions
// that end it.
#include "control/activities/dig/digging.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "control/activities/dig/fill.h"
#include "control/activities/dig/seen_surface.h"
#include "control/dig_pose.h"
#include "control/reach.h"
#include "control/swing_clearance.h"

namespace navvy::control {
namespace {

// The swing starts with the bucket's lowest point this far over the trench's edges [m]; it rises on
// while the swing is still slow.
constexpr double kOverEdge = 0.45;
// The arm is up at the dump when this share of the swing is over, before a heap or a bed's side.
constexpr double kUpBefore = 0.65;
// The bucket opens when the swing is so near to its end [rad].
constexpr double kOpenNear = 0.3;
// The scoop starts from where the bucket has arrived if its start is this near [m].
constexpr double kSameStart = 0.5;
// Share of a slice: when the drag was raised by more on average, the next slice is thinner.
constexpr double kHeldUp = 0.4;
// Mean height by which something in the ground raised a drag [m].
constexpr double kHindered = 0.02;
constexpr double kEmpty = 0.008;      // share of a full bucket: less counts as nothing
constexpr double kWorthwhile = 0.03;  // less makes an empty scoop
// On the last floor a scoop that brings less is not repeated: a high wall sheds as much again and
// again.
constexpr double kLooseParticles = 0.07;
constexpr int kMostEmpty = 3;  // empty scoops in a row that end the dig
// Soil that a heaped bucket loses by itself falls back into the trench: wait while it loses this
// [share] within this time [s], for at most this long after it could swing [s].
constexpr double kDrip = 0.003, kStill = 0.2, kDripPatience = 1.5;
constexpr double kDumpPatience = 3.0;  // [s] of shaking the bucket
constexpr double kEarly = 0.6;         // share of the opening after which an empty bucket may leave
// The bucket comes over the tail of a bed that lies so much along its way [-], if the bed is no
// more than this aside of straight behind it [rad]; elsewhere the other arc would be far longer.
constexpr double kLengthwise = 0.5, kBehind = radians(60);
constexpr double kShake = radians(7), kShakeRate = 2 * kPi * 1.2;  // [rad], [rad/s]
// A scoop's start may be this far out of reach [m]; drives end 0.15 m off.
constexpr double kBeyond = 0.3;
constexpr double kRest = 2.0;    // [s] for loose soil to come to rest before the end
constexpr int kMostCycles = 60;  // of a dig that was ordered no number of them
// Share of the design volume: with more left, a trench is not done
// [docs/validation.md, whole digs].
constexpr double kUndone = 0.15;
constexpr double kThinSlice = 0.25;  // of a slice, for the rest of a load
// A pass along the floor that brings less than this share of a load is the last one: one of the
// first two, a later one, and one along a floor that is not down yet.
constexpr int kFewCleanUps = 2;
constexpr double kLeastCleanUp = 0.15, kLeastLateCleanUp = 0.2, kLeastOnRoughFloor = 0.03;
// Distances nearer and farther at which the bucket may open instead, and their number [m].
constexpr double kAside = 0.25;
constexpr int kAsides = 16;
// During the return swing the arm comes down after this share of the swing, or by steps of a share
// later, until the bucket clears what is below.
constexpr double kArmAfterSwing = 0.4, kArmLater = 0.1;

}  // namespace

void Digging::begin(const Observation& seen) {
  m.stance.begin(seen.X_WB);
  // The soil at the trench's middle decides the mass of a full bucket.
  const scene::Soil soil = surface_soil(*seen.ground, 0.5 * (dig_.from + dig_.to));
  const double fill = dig_.has_fill ? dig_.fill : usual_fill(soil, arm_);
  m.scoop_volume = fill * arm_.bucket().capacity / soil.swell;
  m.full_mass = m.scoop_volume * soil.bank_density;
  m.cohesionless = is_cohesionless(soil) ? 1 : 0;
  if (dig_.gain != nullptr) m.gain = *dig_.gain;
  aim_at(lacking(seen));
  Dig dig = dig_;
  // A small rest of a load takes a thin slice: a thick one fills the bucket on its way down.
  const double share = dig_.is_cut() ? std::clamp(aimed_mass() / m.full_mass, kThinSlice, 1.0) : 1;
  dig.pass_depth *= share;
  plan_ = with_surface(seen, [&](const SurfaceView& surface) {
    return DigPlan(dig, trench_line(dig_, m.stance.swing_frame(arm_)), share * m.scoop_volume,
                   surface);
  });
  // Cycles count over the whole program, limits over this dig.
  m.first_cycle = place_.handover.cycles;
  go_on(kReturn, seen);
}

bool Digging::plan_scoop(const Observation& seen) {
  const double lack = lacking(seen);
  if (dig_.has_load && is_loaded(dig_.load - lack, dig_.load)) return false;
  // Both limits end the dig whatever the plan still sees.
  if (cycles() >= dig_.max_cycles.value_or(kMostCycles) || m.empty_scoops >= kMostEmpty)
    return false;
  if (dig_.levels && cycles() > 0) return false;
  if (cut_is_over()) return false;
  Scoop scoop =
      dig_.levels ? plan_.whole_floor() : with_surface(seen, [&](const SurfaceView& surface) {
        return plan_.next(surface, m.hindered != 0);
      });
  m.cleaning = dig_.levels ? 1 : 0;
  // Soil that fell back is spread along the whole floor, too thin for a scoop of the plan; one or
  // two passes clean it up.
  if (!scoop.any && !dig_.is_cut() && may_clean(seen)) {
    scoop = with_surface(
        seen, [&](const SurfaceView& surface) { return plan_.clean_up(surface, m.hindered != 0); });
    m.cleaning = scoop.any ? 1 : 0;
  }
  if (!scoop.any || beyond_reach(scoop)) return false;
  aim_at(lack);
  m.scoop_start = scoop.start;
  m.soil_start = scoop.soil;
  m.scoop_end = scoop.end;
  m.scoop_level = scoop.level;
  return true;
}

// After each scoop of a job the machine looks for the best cut and place of the spoil again.
bool Digging::cut_is_over() const { return dig_.is_cut() && cycles() > 0; }

bool Digging::may_clean(const Observation& seen) const {
  const double least = m.clean_ups <= kFewCleanUps ? kLeastCleanUp : kLeastLateCleanUp;
  if (m.clean_ups == 0 || m.cleaned >= least * m.full_mass) return true;
  // A pass that the ground held has refused that place, and another takes what is ahead of it.
  if (m.hindered != 0) return true;
  // Walls that go on shedding soil are cleaned up after until the trench is done.
  const TrenchState now =
      with_surface(seen, [&](const SurfaceView& surface) { return plan_.state(surface); });
  return now.left > kUndone * plan_.design_volume() ||
         (now.is_rough() && m.cleaned >= kLeastOnRoughFloor * m.full_mass);
}

bool Digging::beyond_reach(const Scoop& scoop) const {
  const Vec2 p = plan_.point(scoop.start);
  const SwingPoint at = swing_point(
      m.stance.swing_frame(arm_), Vec3(p.x(), p.y(), plan_.floor_height(scoop.start, scoop.level)));
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
  // During the return swing the bucket stays above the trench's edges and the soil spilt on them.
  const double ground = with_surface(seen, [&](const SurfaceView& surface) {
    return next == kReturn ? plan_.highest_beside(surface, m.s) : surface.height(p.x(), p.y());
  });
  const double z = std::max(ground, plan_.floor_height(m.s, m.scoop_level)) + kClear;
  Axes to = m.tip.start(place_, m.stance, p, z, with_cut(arm_, kPlunge));
  // The bucket returns the way it came, where it met nothing: on the shorter arc from a place
  // behind the machine it would meet the cab of a truck.
  if (next == kReturn && std::exchange(place_.handover.is_out, false) && !arm_.swing_limited())
    to[0] = place_.handover.dug_at + std::remainder(to[0] - place_.handover.dug_at, 2 * kPi);
  const double turn = std::min(swing_acceleration(place_, {to[1], to[2], to[3]}, 0, seen),
                               swing_acceleration(place_, place_.arm_angles(), 0, seen));
  m.move.start(place_, to, seen, {1.0, kArmAfterSwing, turn, false});
  // A windrow that has grown between the dump and the trench: the arm stays up until it is past.
  with_surface(seen, [&](const SurfaceView& surface) {
    const Pose X_WS = m.stance.swing_frame(arm_);
    const auto is_clear = [&] {
      return least_clearance(m.move, m.move.arm_delay(), arm_, X_WS, surface) >= kOverHeap;
    };
    for (double wait = kArmAfterSwing; wait < 1 && !is_clear(); wait += kArmLater)
      m.move.start(place_, to, seen, {1.0, std::min(1.0, wait + kArmLater), turn, false});
  });
  enter(next);
}

ArmAngles Digging::opening_pose(const Observation& seen, const Pose& X_WS, Vec2& place) const {
  const Vec2 axis = X_WS.translation().head<2>();
  const Vec2 out = (place - axis).normalized();
  const double reach = (place - axis).norm();
  // On a heap that has grown too high the bucket opens nearer, or beyond it. Over a bed a load that
  // was to lie aside may be out of reach.
  const std::string why = dig_.has_load ? "the bucket does not reach the place in the bed, dumping "
                                        : "the heap is too high to dump on it, dumping ";
  for (int i = 0; i <= kAsides; ++i) {
    const int steps = (i + 1) / 2;
    const double off = kAside * (i % 2 == 0 ? steps : -steps);
    const Vec2 p = axis + (reach + off) * out;
    ArmAngles q;
    double clearance = 0;
    if (!dump_pose(arm_, X_WS, p, heap_at(seen, p), dig_.dump_height, q, clearance)) continue;
    if (i > 0) place_.warn(why + metres(std::abs(off)) + (off < 0 ? " nearer" : " farther out"));
    place = p;
    return q;
  }
  place_.warn(why + "from where the bucket is");
  return place_.arm_angles();
}

double Digging::heap_at(const Observation& seen, const Vec2& p) {
  return with_surface(seen, [&](const SurfaceView& surface) { return heap_height(surface, p); });
}

double Digging::arc_to(double swing, const Vec2& out) const {
  // With limits there is only one.
  if (arm_.swing_limited()) return swing;
  const double from = place_.handover.q[0], turn = std::remainder(swing - from, 2 * kPi);
  // A swing to the left moves the bucket along a bed towards its front if this is positive.
  const double ahead = Vec2(-out.y(), out.x()).normalized().dot(dig_.spread.normalized());
  const bool over_cab = std::abs(ahead) > kLengthwise && (ahead > 0) != (turn > 0);
  if (!over_cab || kPi - std::abs(turn) > kBehind) return from + turn;
  return from + turn - std::copysign(2 * kPi, turn);
}

void Digging::start_carry(const Observation& seen) {
  Vec2 place = dump_place(seen);
  const Pose X_WS = m.stance.swing_frame(arm_);
  // The heap grows from cycle to cycle: the bucket opens over its present height.
  ArmAngles q = opening_pose(seen, X_WS, place);
  const SwingPoint over = swing_point(X_WS, Vec3(place.x(), place.y(), heap_at(seen, place)));
  double swing = arc_to(over.swing, place - X_WS.translation().head<2>());
  place_.handover.dug_at = place_.handover.q[0];
  place_.handover.is_out = true;
  with_surface(seen, [&](const SurfaceView& surface) {
    m.edge = plan_.highest_beside(surface, m.s) + kOverEdge;
    if (dig_.has_load) return;
    CarrySwing way{place_.handover.dug_at, swing, place, X_WS};
    pass_over(arm_, surface, way, q);
    swing = way.to;
    // The swing begins before the arm is up.
    m.edge = std::max(m.edge, std::min(highest_on_arc(way, kUpBefore, surface),
                                       lowest_point(arm_.forward(q), arm_, X_WS)));
  });
  const double turn = std::min(swing_acceleration(place_, q, seen.payload, seen),
                               swing_acceleration(place_, place_.arm_angles(), seen.payload, seen));
  m.move.start(place_, with_arm(swing, q), seen, {1.2, 0, turn, true});
  m.held = seen.payload;
  m.held_since = 0;
  trim_.start();
  enter(kLift);
}

BucketPose Digging::bucket_pose(const Observation& seen) const {
  ArmAngles q;
  for (std::size_t i = 0; i < 3; ++i) q[i] = seen.joints[place_.joint(i + 1)].position;
  return arm_.forward(q);
}

bool Digging::is_above(const Observation& seen, double z) const {
  return lowest_point(bucket_pose(seen), arm_, m.stance.swing_frame(arm_)) >= z;
}

bool Digging::lift(const Observation& seen) {
  m.move.advance(place_, seen, phase_time(), phase());
  const bool drip = drips(seen);
  const double up = std::max(0.0, m.move.arm_time() - kUpBefore * m.move.swing_time());
  const bool late = phase_time() > m.move.arm_time() + kDripPatience;
  return late || (phase_time() >= up && is_above(seen, m.edge) && !drip);
}

bool Digging::drips(const Observation& seen) {
  // Every loss restarts the clock.
  if (seen.payload < (1 - kDrip) * m.held) {
    m.held = seen.payload;
    m.held_since = phase_time();
  }
  return phase_time() < m.held_since + kStill;
}

bool Digging::swing(const Observation& seen) {
  if (m.move.advance(place_, seen, m.lifted + phase_time(), phase())) return true;
  return std::abs(seen.joints[place_.joint(0)].position - m.move.target(0)) < kOpenNear;
}

void Digging::start_dump(const Observation& seen) {
  m.opened = m.lifted + phase_time();
  m.move.open_on_the_way(place_, seen, m.opened);
  landing_.start(seen);
  enter(kDump);
}

void Digging::thin_slices() {
  const double raised = m.held_up + m.lift_before * (m.scoop_start - m.s);
  m.hindered = raised > kHindered * (m.scoop_start - m.s) ? 1 : 0;
  // A boulder raises the path for a part of the drag, soil that is too strong for all of it.
  if (m.cleaning != 0 || m.held_up <= kHeldUp * plan_.slice() * (m.scoop_start - m.s)) return;
  if (plan_.thin())
    place_.warn("the soil holds the bucket: slices of " + metres(plan_.slice()) + " from now on");
}

bool Digging::met_undiggable(const Observation& seen) const {
  // A pass along the whole floor may bring little, unless something in the ground raised it.
  if (m.cleaning != 0) return m.hindered != 0 && seen.payload < kWorthwhile * m.full_mass;
  return seen.payload < (m.scoop_level < dig_.depth ? kWorthwhile : kLooseParticles) * m.full_mass;
}

bool Digging::is_empty(const Observation& seen) const {
  return seen.payload < kEmpty * m.full_mass && !(dig_.holds && dig_.holds(seen));
}

bool Digging::dump(const Observation& seen) {
  // After the opening the shaking controls the bucket's joint: the move must not take it back.
  const double since = m.opened + phase_time();
  const bool open = since > m.move.duration() || m.move.advance(place_, seen, since, phase());
  const bool empty = is_empty(seen);
  shake(seen);
  // The bucket need not open fully when it is empty before.
  if (empty && phase_time() > kEarly * m.move.open_time()) return true;
  return open && (empty || since > m.move.duration() + kDumpPatience);
}

void Digging::shake(const Observation& seen) {
  // Sticky soil: a few strokes of the bucket cylinder, as every operator does.
  const double since = m.opened + phase_time() - m.move.duration();
  if (since <= 0 || is_empty(seen)) return;
  const double stroke = kShake * std::sin(kShakeRate * since);
  place_.handover.q[3] =
      std::clamp(m.move.target(3) - std::abs(stroke), arm_.lower(2), arm_.upper(2));
}

void Digging::look_round(const Observation& seen) {
  if (dig_.is_cut()) return enter(kLook);
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

void Digging::arrive(const Observation& seen) {
  const double here = m.s;
  if (!plan_scoop(seen)) return look_round(seen);
  if (std::abs(m.scoop_start - here) > kSameStart) return go_to_scoop(kApproach, seen);
  start_scoop(seen);
}

void Digging::start_scoop(const Observation& seen) {
  const Vec2 p = plan_.point(m.scoop_start);
  m.ground =
      with_surface(seen, [&](const SurfaceView& surface) { return surface.height(p.x(), p.y()); });
  // What the ground under the wheels has done so far was not caused by the bucket.
  m.stance.settle();
  m.clean_ups += m.cleaning;
  tell(CycleEvent::kScoopStart);
  enter(kPenetrate);
}

bool Digging::end_cycle(const Observation& seen) {
  // After a pause, look again: soil may have slid into the trench, or come to rest there. The cuts
  // of a job are looked at together; but what was dumped last must have landed in the bed.
  const bool rests = !dig_.is_cut() || !dig_.into.empty();
  // `m.move` of a cut is still the carry: advancing it again would take the arm back through the
  // bed's side.
  if (!dig_.is_cut() && !move(seen)) return false;
  if (rests && phase_time() < kRest) return false;
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

bool Digging::conclude_load(const Observation& seen) {
  const double lack = lacking(seen);
  const std::string loaded = "'" + dig_.into + "' holds " + number_text(dig_.load - lack, "kg") +
                             " of " + number_text(dig_.load, "kg") + " after " +
                             std::to_string(cycles()) + " passes";
  if (is_loaded(dig_.load - lack, dig_.load)) {
    remark(loaded);
    return true;
  }
  if (cycles() >= dig_.max_cycles.value_or(kMostCycles))
    return fall_short(StepState::kOutOfTime, loaded);
  return fall_short(StepState::kBlocked, "no more soil comes into the bucket; " + loaded);
}

bool Digging::conclude(const Observation& seen) {
  // A cut that is over before the bed is full is no failure: the job has others.
  if (dig_.has_load && !dig_.is_cut()) return conclude_load(seen);
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
  if (dig_.is_cut()) return true;
  // A program that sets a number of cycles wants these, not the trench.
  if (dig_.max_cycles && cycles() >= *dig_.max_cycles) {
    remark("made its " + std::to_string(*dig_.max_cycles) + " cycles; " + left);
  } else if (const Scoop next = with_surface(
                 seen, [&](const SurfaceView& s) { return plan_.next(s, m.hindered != 0); });
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
  if (dig_.has_load) out.push_back({"loaded_kg", dig_.load - lacking(seen)});
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

bool Digging::update(const Observation& seen, double dt, Command& out) {
  // Filtered in all phases, or the pose would jump when it is used again.
  m.stance.follow(seen.X_WB, dt);
  switch (phase_index()) {
    case kReturn:
      // Soil that was loose when the bucket left has come to rest by now.
      if (!move(seen)) break;
      if (falls_short_of_receiver(seen)) return true;
      arrive(seen);
      break;
    case kApproach:
      if (move(seen)) start_scoop(seen);
      break;
    case kPenetrate:
      // Enters the drag itself: by depth, by stall, or by time.
      penetrate(seen, dt, out);
      break;
    case kDrag:
      if (!drag(seen, dt, out)) break;
      thin_slices();
      tell(CycleEvent::kCurlStart);
      enter(kCurl);
      break;
    case kCurl:
      if (!curl(seen, dt, out)) break;
      m.tip.hand_over(place_);
      start_carry(seen);
      break;
    case kLift:
      // Falling surplus is no drip to wait for.
      if (!(lift(seen) || trim_.opening() > 0) || trims(seen, dt)) break;
      m.lifted = phase_time();
      m.move.release_swing(m.lifted);
      tell(CycleEvent::kLiftOut);
      enter(kSwing);
      break;
    case kSwing:
      if (!swing(seen)) break;
      if (m.cleaning != 0) m.cleaned = seen.payload;
      m.empty_scoops = seen.payload < kWorthwhile * m.full_mass ? m.empty_scoops + 1 : 0;
      if (met_undiggable(seen))
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
  a("cleaned", cleaned);
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
  a("cohesionless", cohesionless);
  a("lift_before", lift_before);
  a("held_up", held_up);
  a("hindered", hindered);
  a("ground", ground);
  a("edge", edge);
  a("held", held);
  a("held_since", held_since);
  a("lifted", lifted);
  a("opened", opened);
}

void Digging::visit(Archive& a) {
  ActivityWith::visit(a);
  // The phase indexes a table of names.
  a.require(phase_index() >= kReturn && phase_index() <= kLook, "phase", "no phase of a dig");
  a("plan", plan_);
  // Only digs to a stated mass have it; others keep their bytes.
  if (dig_.has_load) {
    a("wanted", m.wanted);
    a.ranged("gain", m.gain, kLeastGain, kMostGain);
    a("trim", trim_);
  }
  landing_.visit(a);
}

}  // namespace navvy::control
