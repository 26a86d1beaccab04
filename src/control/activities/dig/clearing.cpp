// SPDX-License-Identifier: Apache-2.0
// Bodies one after the other: a scoop for each, and a look at where it lies then.
#include "control/activities/dig/clearing.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "control/activities/dig/seen_surface.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// Depth that each further try adds, and the most that they add [m].
constexpr double kDeeper = 0.05, kDeepest = 0.4;
// A dumped body has come to rest below this speed [m/s], after this time at the earliest and at the
// latest [s].
constexpr double kAtRest = 0.05, kShortest = 0.5, kLongest = 6;
// Distance from the dump within which bodies make the bucket open higher, and by how much the tip
// clears them [m].
constexpr double kHeapRadius = 1.2, kOverHeap = 0.3;
// A body is in the bucket if its middle is at most this share of its size outside the outline.
constexpr double kProud = 0.25;

std::vector<BodyView> bodies_of(const Observation& seen) {
  return seen.bodies ? seen.bodies() : std::vector<BodyView>{};
}

/// Returns the body of this name; nothing if there is none.
std::optional<BodyView> find(const std::vector<BodyView>& bodies, const std::string& name) {
  const auto one =
      std::find_if(bodies.begin(), bodies.end(), [&](const auto& b) { return b.name == name; });
  return one == bodies.end() ? std::nullopt : std::optional<BodyView>(*one);
}

std::string count_text(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

void ClearTarget::visit(Archive& a) {
  a("name", name);
  a("tries", tries);
  a("trouble", trouble);
}

void ClearMemory::visit(Archive& a) {
  a("targets", targets);
  a("aim", aim);
  a.require(aim >= 0 && aim <= static_cast<std::int64_t>(targets.size()), "aim",
            "there is no such body");
  a("strip", strip);
  a("dump_height", dump_height);
  a("taken", taken);
}

void Clearing::begin(const Observation& seen) {
  for (const BodyView& body : bodies_in(step_.polygon, bodies_of(seen)))
    m.targets.push_back({body.name, 0, ""});
  enter(kNext);
}

bool Clearing::is_cleared(const Observation& seen, const BodyView& body) const {
  return bodies_in(step_.polygon, {body}).empty() &&
         (body.centre.head<2>() - step_.dump_at).norm() <= step_.tolerance && !holds(seen, body);
}

bool Clearing::is_held(const Observation& seen) const {
  const std::optional<BodyView> body = find(bodies_of(seen), target().name);
  return body && holds(seen, *body);
}

bool Clearing::holds(const Observation& seen, const BodyView& body) const {
  const ArmKinematics& arm = *place_.arm;
  ArmAngles q;
  for (std::size_t i = 0; i < 3; ++i) q[i] = seen.joints[place_.joint(i + 1)].position;
  const double swing = seen.joints[place_.joint(0)].position;
  const Vec3 p = Eigen::AngleAxisd(-swing, Vec3::UnitZ()) *
                 Vec3((seen.X_WB * arm.X_BS()).inverse() * body.centre);
  const BucketPose tip = arm.forward(q);
  return std::abs(p.y()) < 0.5 * arm.bucket().width &&
         arm.is_in_bucket(tip.angle, Vec2(p.x() - tip.reach, p.z() - tip.height),
                          kProud * body.largest);
}

bool Clearing::select(const Observation& seen) {
  const std::vector<BodyView> bodies = bodies_of(seen);
  const Pose X_WS = seen.X_WB * place_.arm->X_BS();
  // Another body where the bucket goes down holds it; one in front is pushed along.
  using Rank = std::tuple<std::int64_t, std::int64_t, double>;
  std::optional<Rank> best;
  for (std::size_t i = 0; i < m.targets.size(); ++i) {
    ClearTarget& one = m.targets[i];
    const std::optional<BodyView> body = find(bodies, one.name);
    if (!body || is_cleared(seen, *body) || one.tries >= step_.tries) continue;
    const double reach = (body->centre - X_WS.translation()).head<2>().norm();
    const double depth = step_.depth + std::min(kDeepest, kDeeper * static_cast<double>(one.tries));
    const std::optional<ClearStrip> strip = with_surface(seen, [&](const SurfaceView& surface) {
      return clear_strip(*place_.arm, X_WS, *body, bodies, depth, surface);
    });
    if (!strip) {
      one.trouble = metres(reach) + " from the swing axis, it is out of reach";
      continue;
    }
    const Rank rank{strip->behind, strip->before, reach};
    if (best && rank >= *best) continue;
    best = rank;
    m.aim = static_cast<std::int64_t>(i);
    m.strip = *strip;
  }
  if (!best) return false;
  m.dump_height = height_of_dump(seen, bodies);
  return true;
}

double Clearing::height_of_dump(const Observation& seen,
                                const std::vector<BodyView>& bodies) const {
  const double ground = with_surface(seen, [&](const SurfaceView& surface) {
    return surface.height(step_.dump_at.x(), step_.dump_at.y());
  });
  double height = step_.dump_height;
  for (const BodyView& body : bodies)
    if ((body.centre.head<2>() - step_.dump_at).norm() < kHeapRadius + body.radius())
      height = std::max(height, body.top() - ground + kOverHeap);
  return height;
}

void Clearing::make_part() {
  auto step = std::make_unique<Dig>();
  step->from = m.strip.far;
  step->to = m.strip.near;
  step->floor = m.strip.floor;
  step->rim = m.strip.rim;
  step->width = place_.arm->bucket().width;
  // One pass along the whole strip, whatever soil it brings.
  step->levels = true;
  step->has_fill = true;
  step->fill = 1;
  step->dump_at = step_.dump_at;
  step->dump_height = m.dump_height;
  step->holds = [this](const Observation& seen) { return is_held(seen); };
  part_.make(std::move(step), place_);
}

bool Clearing::go_on(const Observation& seen) {
  if (!select(seen)) return conclude(seen);
  m.taken = false;
  ++target().tries;
  enter(kScoop);
  make_part();
  part_->begin(seen);
  return false;
}

bool Clearing::is_moving(const Observation& seen) const {
  if (phase_time() < kShortest) return true;
  const std::optional<BodyView> body = find(bodies_of(seen), target().name);
  return body && body->speed > kAtRest && phase_time() < kLongest;
}

void Clearing::judge(const Observation& seen, const std::string& failure) {
  const std::optional<BodyView> body = find(bodies_of(seen), target().name);
  if (!body || is_cleared(seen, *body)) return;
  const Vec2 place = body->centre.head<2>();
  if (!failure.empty())
    target().trouble = failure;
  else if (holds(seen, *body))
    target().trouble = "it stuck in the bucket";
  else if (!m.taken)
    target().trouble = "the bucket did not take it up";
  else if (bodies_in(step_.polygon, {*body}).empty())
    target().trouble = "it was dumped " + metres((place - step_.dump_at).norm()) +
                       " from the place, more than " + metres(step_.tolerance);
  else
    target().trouble = "it fell from the bucket";
  place_.warn("'" + target().name + "' is at " + place_text(place) + " after try " +
              std::to_string(target().tries) + " of " + std::to_string(step_.tries) + ": " +
              target().trouble);
}

bool Clearing::update(const Observation& seen, double dt, Command& out) {
  if (part_) {
    const bool over = part_->advance(seen, dt, out);
    if (const CycleEvent event = part_->take_event(); event != CycleEvent::kNone) {
      if (event == CycleEvent::kLiftOut) m.taken = is_held(seen);
      tell(event);
    }
    if (!over) return false;
    target().trouble = fell_short(part_->state()) ? part_->reason() : "";
    part_.clear();
    enter(kRest);
    return false;
  }
  if (phase_index() == kRest) {
    if (is_moving(seen)) return false;
    judge(seen, target().trouble);
    enter(kNext);
    return false;
  }
  return go_on(seen);
}

bool Clearing::conclude(const Observation& seen) {
  const std::vector<BodyView> bodies = bodies_of(seen);
  std::string left;
  std::size_t count = 0;
  for (const ClearTarget& one : m.targets) {
    const std::optional<BodyView> body = find(bodies, one.name);
    if (body && is_cleared(seen, *body)) continue;
    ++count;
    left += (left.empty() ? ": '" : "; '") + one.name + "'";
    if (body) left += " at " + place_text(body->centre.head<2>());
    left += " after " + count_text(static_cast<std::size_t>(one.tries), "try", "tries") +
            (one.trouble.empty() ? "" : ", " + one.trouble);
  }
  if (count > 0)
    return fall_short(StepState::kBlocked, std::to_string(count) + " of " +
                                               count_text(m.targets.size(), "body", "bodies") +
                                               " left" + left);
  if (m.targets.empty()) remark("no loose body was in the polygon");
  return true;
}

const char* Clearing::phase() const {
  if (part_) return part_->phase();
  return phase_index() == kRest ? "look" : "plan";
}

std::vector<Measurement> Clearing::account(const Observation& seen) const {
  const std::vector<BodyView> bodies = bodies_of(seen);
  double cleared = 0, scoops = 0, farthest = 0;
  for (const ClearTarget& one : m.targets) {
    scoops += static_cast<double>(one.tries);
    const std::optional<BodyView> body = find(bodies, one.name);
    if (!body || !is_cleared(seen, *body)) continue;
    ++cleared;
    farthest = std::max(farthest, (body->centre.head<2>() - step_.dump_at).norm());
  }
  const auto all = static_cast<double>(m.targets.size());
  return {{"bodies", all},
          {"cleared", cleared},
          {"left", all - cleared},
          {"tries", scoops},
          {"farthest_m", farthest}};
}

void Clearing::visit(Archive& a) {
  ActivityWith::visit(a);
  a.require(phase_index() >= kNext && phase_index() <= kRest, "phase", "no phase of a clear");
  a.require(phase_index() == kNext || m.aim < static_cast<std::int64_t>(m.targets.size()), "aim",
            "no body is taken in this phase");
  part_.visit(a, [&] {
    a.require(phase_index() == kScoop, "running", "no scoop runs in this phase");
    make_part();
  });
}

}  // namespace navvy::control
