// SPDX-License-Identifier: Apache-2.0
// Presses of the bucket: over a place, down until the ground holds it, up, and on to the next.
#include "control/activities/bucket_press.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "control/activities/dig/seen_surface.h"
#include "control/activities/press_places.h"
#include "control/activities/top_soil.h"
#include "control/arm_move.h"
#include "control/stance.h"
#include "control/tip_path.h"
#include "scene/polygon.h"

namespace navvy::control {
namespace {

// Heights of the bucket over the ground between two presses, and when all are made [m].
constexpr double kOver = 0.3, kAway = 1.0;
// Share of its usual speed at which the arm moves away.
constexpr double kSlow = 0.5;
// Speeds down to the ground, and on it [m/s]; deceleration before the ground [m/s2], to this height
// over it [m].
constexpr double kDownAir = 0.6, kDownSoil = 0.08, kBrake = 1.0, kNearGround = 0.05;
// Least share of the speed on the ground shortly before a stated force.
constexpr double kCreep = 0.1;
// A press is held at its limit for this time [s]: longer than soil needs to yield.
constexpr double kHold = 1.0;
// The bucket goes no deeper than this into soil that does not hold it [m].
constexpr double kDeepest = 0.3;
// Rise of the machine's side towards the bucket at which it presses no harder [rad]: tyres that
// carry no load any more let it rise by about as much. Beyond this share of it, it presses less.
constexpr double kMostRise = radians(0.75), kTooMuch = 1.3;
// It presses no harder either when it has risen by this and its centre of pressure is so near to
// the edge of its support polygon [rad], [m].
constexpr double kSomeRise = radians(0.2), kLeastMargin = 0.25;
// Share of a cylinder's force at which the arm is at its limit.
constexpr double kStrained = 0.9;
// Rise of the path by which soil that holds the tip has stopped it [m].
constexpr double kStopped = 0.01;
// Time for one press [s], and for loose soil to come to rest before the end [s]: it rests after
// 0.8 s [docs/exchange.md, deposit].
constexpr double kPressPatience = 20, kRest = 3;
// A place must be reached so far below the ground, where soil yields [m].
constexpr double kBelow = 0.1;
// Share of the swing after which the arm moves on the way to the first place.
constexpr double kArmAfterSwing = 0.4;

struct PressMemory {
  Stance stance;
  TipPath tip;
  ArmMove move;
  std::vector<Vec2> places;  // of the middle of the flat bottom
  std::int64_t place = 0;    // index of the present one
  std::int64_t pass = 0;     // number of passes that are over
  std::int64_t missed = 0;   // places that were left out
  std::int64_t presses = 0;  // that were made
  TopSoil before;
  Vec2 axis = Vec2::Zero();  // of the swing, when the step began
  double ground = 0;         // under the present place [m]
  double held = 0;           // time at the limit [s]
  double force = 0;          // greatest one of the present press [N]
  double forces = 0;         // sum of the greatest ones of all presses [N]

  void visit(Archive& a) {
    a("stance", stance);
    a("tip", tip);
    a("move", move);
    a("places", places);
    a("place", place);
    a.require(place >= 0 && place <= static_cast<std::int64_t>(places.size()), "place",
              "the step has no such place");
    a("pass", pass);
    a("missed", missed);
    a("presses", presses);
    before.visit(a);
    a("axis", axis);
    a("ground", ground);
    a("held", held);
    a("force", force);
    a("forces", forces);
  }
};

/// Returns true if the bucket can be pressed on the ground with its tip at `tip`: within the limits
/// of the swing, ahead of the undercarriage and with its bottom level.
bool is_within_reach(const ArmKinematics& arm, const FlatBottom& bottom, const SwingPoint& tip) {
  return arm.swings_to(tip.swing) && tip.reach >= kNearestDig && can_press_at(arm, bottom, tip);
}

class Pressing final : public ActivityWith<PressMemory> {
 public:
  Pressing(OperatorContext& place, const Compact& step)
      : ActivityWith(place), step_(step), arm_(*place.arm), bottom_(flat_bottom(arm_)) {}

  void begin(const Observation& seen) override {
    m.stance.begin(seen.X_WB);
    m.axis = m.stance.swing_frame(arm_).translation().head<2>();
    m.places = press_places(step_.polygon, m.axis, bottom_);
    m.before = top_soil_in(step_.polygon, *seen.ground);
    enter(kNext);
  }
  // In the order of Phase.
  const char* phase() const override {
    static const char* const names[] = {"plan", "approach", "press", "lift", "look"};
    return names[phase_index()];
  }
  std::vector<Measurement> account(const Observation& seen) const override {
    const auto all = static_cast<std::int64_t>(m.places.size()) + m.missed;
    std::vector<Measurement> out = {{"places", static_cast<double>(all)},
                                    {"places_missed", static_cast<double>(m.missed)},
                                    {"passes", static_cast<double>(step_.passes)}};
    add_settlement(m.before, top_soil_in(step_.polygon, *seen.ground), out);
    out.push_back({"press_n", m.presses > 0 ? m.forces / static_cast<double>(m.presses) : 0});
    return out;
  }
  void visit(Archive& a) override {
    ActivityWith::visit(a);
    a.require(phase_index() >= kNext && phase_index() <= kLook, "phase", "no phase of a compact");
    a.require(phase_index() == kNext || phase_index() == kLook || !past_last(), "place",
              "no place is pressed in this phase");
  }

 private:
  enum Phase : std::int64_t { kNext, kApproach, kPress, kLift, kLook };

  bool update(const Observation& seen, double dt, Command& out) override {
    m.stance.follow(seen.X_WB, dt);
    switch (phase_index()) {
      case kNext:
        go_on(seen);
        return false;
      case kApproach:
        if (m.move.advance(place_, seen, phase_time(), phase())) start_press();
        return false;
      case kPress:
        if (press(seen, dt, out)) end_press(seen);
        return false;
      case kLift:
        if (!m.move.advance(place_, seen, phase_time(), phase())) return false;
        ++m.place;
        enter(kNext);
        return false;
      default:  // kLook
        return phase_time() >= kRest && conclude();
    }
  }

  bool past_last() const { return m.place >= static_cast<std::int64_t>(m.places.size()); }
  const Vec2& present() const { return m.places[static_cast<std::size_t>(m.place)]; }
  Vec2 tip_place() const { return bottom_.tip_at(present(), m.axis); }
  bool is_last() const {
    return m.pass + 1 >= step_.passes && m.place + 1 >= static_cast<std::int64_t>(m.places.size());
  }

  /// Goes to the next place, or waits for the soil to come to rest after the last press.
  void go_on(const Observation& seen) {
    if (past_last()) {
      ++m.pass;
      m.place = 0;
    }
    if (m.places.empty() || m.pass >= step_.passes) return enter(kLook);
    m.ground = with_surface(seen, [&](const SurfaceView& surface) {
      return ground_under(surface, present(), m.axis, bottom_);
    });
    const Pose X_WS = m.stance.swing_frame(arm_);
    for (const double height : {kOver, 0.0}) {
      const Vec2 p = tip_place();
      if (!is_within_reach(arm_, bottom_, swing_point(X_WS, Vec3(p.x(), p.y(), m.ground + height))))
        return leave_out("it is out of the bucket's reach");
    }
    move_over(kOver, kArmAfterSwing, seen);
    enter(kApproach);
  }

  /// Starts a move to the height `height` [m] over the present place.
  void move_over(double height, double arm_delay, const Observation& seen) {
    const Axes to = m.tip.start(place_, m.stance, tip_place(), m.ground + height, bottom_.angle);
    const double turn = std::min(swing_acceleration(place_, {to[1], to[2], to[3]}, 0, seen),
                                 swing_acceleration(place_, place_.arm_angles(), 0, seen));
    // The last move is slow: a raised arm rocks the machine.
    m.move.start(place_, to, seen, {height > kOver ? kSlow : 1, arm_delay, turn, false});
  }

  /// Takes the present place out of this pass and all others.
  void leave_out(const std::string& why) {
    place_.warn("the place at " + place_text(present()) + " is left out: " + why);
    m.places.erase(m.places.begin() + m.place);
    ++m.missed;
    enter(kNext);
  }

  void start_press() {
    m.held = m.force = 0;
    enter(kPress);
  }

  /// Returns true if the bucket presses as hard as it may.
  bool is_at_limit(const Observation& seen, double rise) const {
    double strain = 0;
    for (std::size_t i = 1; i < 4; ++i) {
      const vehicle::JointState& joint = seen.joints[place_.joint(i)];
      if (joint.effort_limit > 0)
        strain = std::max(strain, std::abs(joint.effort) / joint.effort_limit);
    }
    const bool leans =
        seen.stability.free && rise > kSomeRise && seen.stability.loaded_margin < kLeastMargin;
    return (step_.has_press && seen.force >= step_.press) || rise > kMostRise || leans ||
           strain > kStrained || m.tip.lift > kStopped;
  }

  /// Returns the share of the speed on the ground: less near a stated force, which is felt late.
  double pace_on_soil(const Observation& seen) const {
    return step_.has_press ? std::clamp(2 * (1 - seen.force / step_.press), kCreep, 1.0) : 1;
  }

  /// Lowers the bucket until it is at its limit, and holds it there; returns true when the press is
  /// over.
  bool press(const Observation& seen, double dt, Command& out) {
    const double above = m.tip.z - m.ground - kNearGround;
    // What the ground under the wheels has done up to here was not caused by the bucket.
    if (above > 0) m.stance.settle();
    const double rise = m.stance.rise(seen.X_WB, arm_, seen.joints[place_.joint(0)].position);
    const bool at_limit = above <= 0 && is_at_limit(seen, rise);
    const double down = std::min(
        kDownAir, pace_on_soil(seen) * kDownSoil + std::sqrt(2 * kBrake * std::max(0.0, above)));
    if (rise > kTooMuch * kMostRise)
      m.tip.z += kDownSoil * dt;
    else if (!at_limit)
      m.tip.z -= down * m.tip.slow * dt;
    m.tip.follow(place_, m.stance, tip_place(), seen, dt, TipPath::Part::kDown, out);
    // From then on the soil may yield again.
    if (m.held > 0 || at_limit) m.held += dt;
    m.force = std::max(m.force, seen.force);
    return m.held >= kHold || m.tip.z < m.ground - kDeepest || phase_time() > kPressPatience;
  }

  void end_press(const Observation& seen) {
    m.tip.hand_over(place_);
    if (phase_time() > kPressPatience)
      place_.warn("the press at " + place_text(present()) + " took more than " +
                  number_text(kPressPatience, "s"));
    ++m.presses;
    m.forces += m.force;
    move_over(is_last() ? kAway : kOver, 0, seen);
    enter(kLift);
  }

  bool conclude() {
    const auto all = static_cast<std::int64_t>(m.places.size()) + m.missed;
    return (m.missed == 0 && all > 0) ||
           Activity::fall_short(StepState::kBlocked, std::to_string(m.missed) + " of " +
                                                         std::to_string(all) +
                                                         " places could not be pressed");
  }

  const Compact& step_;
  const ArmKinematics& arm_;
  const FlatBottom bottom_;
};

/// Returns the distances of the tip from the swing axis between which the bottom can lie level at
/// `height` [m] over the swing ring.
TipReach press_reach(const ArmKinematics& arm, const FlatBottom& bottom, const SwingPoint& at) {
  TipReach out;
  SwingPoint tip = at;
  for (tip.reach = kNearestDig; tip.reach < arm.longest() + 2; tip.reach += 0.02) {
    if (!can_press_at(arm, bottom, tip)) continue;
    if (out.most == 0) out.least = tip.reach;
    out.most = tip.reach;
  }
  return out;
}

/// Warns of soils in the polygon that only wheels can make denser.
void warn_of_soils(const Compact& step, ReachCheck& check) {
  const heightfield::Terrain& site = check.surface.terrain();
  std::set<std::string> hard;
  Vec2 low = step.polygon.front(), high = low;
  for (const Vec2& p : step.polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec2i from = site.column_at(low.x(), low.y()), to = site.column_at(high.x(), high.y());
  for (int iy = from.y(); iy <= to.y(); ++iy)
    for (int ix = from.x(); ix <= to.x(); ++ix) {
      const Vec2 p = site.origin() + site.cell() * Vec2(ix + 0.5, iy + 0.5);
      if (!site.contains(ix, iy) || !scene::contains(step.polygon, p)) continue;
      const scene::Soil& soil = site.setup().soils.at(site.surface_soil(ix, iy));
      if (!(soil.compaction_pressure > 0)) hard.insert(soil.name);
    }
  for (const std::string& name : hard)
    check.warn("compact/with", name,
               "the bucket makes soil denser only if it has a compaction_pressure_pa; without one "
               "only wheels do",
               "add <compaction_pressure_pa> to the soil, or use wheels");
}

}  // namespace

std::unique_ptr<Activity> bucket_press(OperatorContext& place, const Compact& step) {
  return std::make_unique<Pressing>(place, step);
}

void check_bucket_press(const Compact& step, ReachCheck& check) {
  const ArmKinematics arm(check.machine);
  const FlatBottom bottom = flat_bottom(arm);
  if (!(bottom.length > 0))
    return check.fault("compact/with", "bucket", "the bucket has no flat bottom",
                       "give it a shell, or use wheels");
  const Pose X_WS = check.X_WB * arm.X_BS();
  const Vec2 axis = X_WS.translation().head<2>();
  const std::vector<Vec2> places = press_places(step.polygon, axis, bottom);
  std::size_t out_of_reach = 0;
  Vec2 first = Vec2::Zero();
  SwingPoint at;
  for (const Vec2& place : places) {
    const Vec2 p = bottom.tip_at(place, axis);
    const double ground = ground_under(check.surface, place, axis, bottom);
    for (const double height : {kOver, -kBelow}) {
      const SwingPoint tip = swing_point(X_WS, Vec3(p.x(), p.y(), ground + height));
      if (is_within_reach(arm, bottom, tip)) continue;
      if (out_of_reach++ == 0) first = place, at = tip;
      break;
    }
  }
  if (out_of_reach > 0) {
    const auto [least, most] = press_reach(arm, bottom, at);
    check.require_swing(arm, "compact/polygon_m", at.swing, "turn the machine");
    check.fault("compact/polygon_m", place_text(first),
                std::to_string(out_of_reach) + " of " + std::to_string(places.size()) +
                    " places are out of reach, this one with the tip " + metres(at.reach) +
                    " from the swing axis; " +
                    (most > 0 ? "there the bottom of the bucket lies level from " + metres(least) +
                                    " to " + metres(most)
                              : "at that height the bottom of the bucket lies level nowhere"),
                "move the machine, or compact a smaller area");
  }
  check.note(std::to_string(places.size()) + (places.size() == 1 ? " place" : " places") +
             " of the bucket, each pressed " + std::to_string(step.passes) +
             (step.passes == 1 ? " time" : " times"));
  warn_of_soils(step, check);
}

}  // namespace navvy::control
