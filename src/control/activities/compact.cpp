// SPDX-License-Identifier: Apache-2.0
#include "control/activities/compact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "control/activities/bucket_press.h"
#include "control/activities/drive_to.h"
#include "control/activities/go_to.h"
#include "control/activities/part.h"
#include "control/activities/top_soil.h"
#include "control/activity.h"
#include "control/reach.h"
#include "scene/polygon.h"
#include "vehicle/collision_box.h"

namespace navvy::control {
namespace {

constexpr double kOverlap = 0.05;  // of neighbouring tracks [m]
constexpr double kBeyond = 0.5;    // of the outermost wheels beyond the polygon [m]
// Tolerances of a lane's beginning and end [m], [rad].
constexpr double kAtStart = 0.15, kAtHeading = radians(3), kAtEnd = 0.4;
// A lane begins here already if its start is so near [m].
constexpr double kHere = 0.2;
// The drive to a lane is straight if the machine is turned by so little [rad] and so little aside,
// as a share of the distance along the lane; ends of such drives may be so far off [m].
constexpr double kTurned = radians(15), kSlant = 0.3, kNearStart = 0.3;

/// Interval of widths that a wheel rolls, and lengths between which wheels stand, in the base's
/// frame [m].
struct Tracks {
  std::vector<std::pair<double, double>> bands;
  double rear = std::numeric_limits<double>::infinity(), front = -rear;
};
Tracks tracks_of(const scene::Machine& machine) {
  Tracks out;
  if (machine.links.empty()) return out;
  const Pose X_BM = machine.links[0].X_ML.inverse();
  for (const scene::Wheel& wheel : machine.wheels) {
    const std::optional<vehicle::WheelBox> around = vehicle::box_of(machine, wheel);
    if (!around) continue;
    const Pose X_BO = X_BM * machine.links[around->link].X_ML * around->box.X_WO;
    const Vec3 half = X_BO.linear().cwiseAbs() * around->box.half;
    const Vec3 middle = X_BO.translation();
    out.bands.emplace_back(middle.y() - half.y(), middle.y() + half.y());
    out.rear = std::min(out.rear, middle.x() - half.x());
    out.front = std::max(out.front, middle.x() + half.x());
    if (!wheel.track) continue;
    // The box is that of the sprocket.
    const double idler = (X_BM * wheel.track->p_idler).x(), radius = wheel.track->idler_radius;
    out.rear = std::min(out.rear, idler - radius);
    out.front = std::max(out.front, idler + radius);
  }
  return out;
}

/// Returns the offsets of the base at which the bands together cover the interval from `low` to
/// `high` [m].
std::vector<double> offsets(const std::vector<std::pair<double, double>>& bands, double low,
                            double high) {
  std::vector<double> out;
  const double middle = 0.5 * (low + high);
  double covered = low;
  while (covered < high) {
    // The band that covers the next stretch with the machine nearest to the middle.
    double best = std::numeric_limits<double>::infinity(), width = 0;
    for (const auto& [right, left] : bands) {
      const double offset = covered - right;
      if (std::abs(offset - middle) < std::abs(best - middle)) best = offset, width = left - right;
    }
    if (!(width > 2 * kOverlap)) break;
    out.push_back(best);
    covered += width - kOverlap;
    // Other wheels may have covered what is next.
    for (bool grows = true; grows;) {
      grows = false;
      for (const double offset : out)
        for (const auto& [right, left] : bands)
          if (offset + right <= covered && offset + left - kOverlap > covered + 1e-9)
            covered = offset + left - kOverlap, grows = true;
    }
    if (covered + kOverlap >= high) break;
  }
  return out;
}

/// State of a compact, except that of the drive that runs.
struct RollingMemory {
  std::vector<RollerLane> lanes;
  std::int64_t lane = 0;    // index of the present lane
  std::int64_t passes = 0;  // of the present lane
  std::int64_t missed = 0;  // lanes that were left out
  bool planned = false;     // the drive to the present lane follows a planned path
  TopSoil before;
  Vec2 begin = Vec2::Zero();  // where the present drive began

  void visit(Archive& a) {
    std::vector<Vec2> places;
    for (const RollerLane& one : lanes) places.insert(places.end(), {one.from.p, one.to.p});
    double yaw = lanes.empty() ? 0 : lanes.front().from.yaw;
    a("places", places);
    a("yaw", yaw);
    a.require(places.size() % 2 == 0, "places", "a lane has two ends");
    lanes.clear();
    for (std::size_t i = 0; i + 1 < places.size(); i += 2)
      lanes.push_back({{places[i], yaw}, {places[i + 1], yaw}});
    a("lane", lane);
    a.require(lane >= 0 && lane <= static_cast<std::int64_t>(lanes.size()), "lane",
              "the step has no such lane");
    a("passes", passes);
    a("missed", missed);
    a("planned", planned);
    a("begin", begin);
    before.visit(a);
  }
};

class Rolling final : public ActivityWith<RollingMemory> {
 public:
  Rolling(OperatorContext& place, const Compact& step) : ActivityWith(place), step_(step) {}

  void begin(const Observation& seen) override {
    m.lanes = roller_lanes(place_.machine, step_.polygon, plane_pose(seen.X_WB).yaw);
    m.before = top_soil_in(step_.polygon, *seen.ground);
    enter(kNext);
  }
  const char* phase() const override { return part_ ? part_->phase() : "plan"; }
  std::vector<Measurement> account(const Observation& seen) const override {
    std::vector<Measurement> out = {{"lanes", static_cast<double>(m.lanes.size())},
                                    {"lanes_missed", static_cast<double>(m.missed)},
                                    {"passes", static_cast<double>(step_.passes)}};
    add_settlement(m.before, top_soil_in(step_.polygon, *seen.ground), out);
    return out;
  }
  void visit(Archive& a) override {
    ActivityWith::visit(a);
    a.require(phase_index() >= kNext && phase_index() <= kRoll, "phase", "no phase of a compact");
    part_.visit(a, [&] {
      a.require(phase_index() != kNext && m.lane < static_cast<std::int64_t>(m.lanes.size()),
                "running", "no drive runs in this phase");
      make_part();
    });
  }

 private:
  enum Phase : std::int64_t { kNext, kApproach, kRoll };

  RollerLane& lane() { return m.lanes[static_cast<std::size_t>(m.lane)]; }
  /// Makes the drive of the present phase.
  void make_part() {
    if (phase_index() == kApproach && m.planned) {
      auto step = std::make_unique<GoTo>();
      step->target = lane().from.p;
      step->heading = lane().from.yaw;
      step->speed = step_.speed;
      step->tolerance = kAtStart;
      step->turn_tolerance = kAtHeading;
      part_.make(std::move(step), place_);
      return;
    }
    const bool approaches = phase_index() == kApproach, back = m.passes % 2 != 0;
    const PlanePose& to = approaches || back ? lane().from : lane().to;
    const Vec2 ahead(std::cos(to.yaw), std::sin(to.yaw));
    auto step = std::make_unique<DriveTo>();
    step->target = to.p;
    step->heading = to.yaw;
    step->has_heading = true;
    step->speed = (to.p - m.begin).dot(ahead) > 0 ? step_.speed : -step_.speed;
    step->tolerance = approaches ? kNearStart : kAtEnd;
    part_.make(std::move(step), place_);
  }
  /// Returns true if a straight drive leads to the present lane.
  bool is_straight(const PlanePose& at) {
    const PlanePose& to = lane().from;
    const Vec2 ahead(std::cos(to.yaw), std::sin(to.yaw)), line = to.p - at.p;
    const double along = std::abs(line.dot(ahead)),
                 aside = std::sqrt(std::max(0.0, line.squaredNorm() - along * along));
    return aside <= kSlant * along && std::abs(std::remainder(at.yaw - to.yaw, 2 * kPi)) <= kTurned;
  }
  void next_lane() {
    ++m.lane;
    m.passes = 0;
    enter(kNext);
  }
  void end_part() {
    const bool failed = control::fell_short(part_->state());
    const std::string reason = part_->reason();
    part_.clear();
    if (failed && phase_index() == kApproach && !m.planned) {
      place_.warn("the straight drive to lane " + std::to_string(m.lane + 1) +
                  " failed, it plans a path: " + reason);
      m.planned = true;
      return;
    }
    if (failed) {
      ++m.missed;
      place_.warn("lane " + std::to_string(m.lane + 1) + " of " + std::to_string(m.lanes.size()) +
                  " is left out: " + reason);
      return next_lane();
    }
    if (phase_index() == kApproach) return enter(kRoll);
    if (++m.passes >= step_.passes) next_lane();
  }
  bool update(const Observation& seen, double dt, Command& out) override {
    if (part_) {
      if (part_->advance(seen, dt, out)) end_part();
      return false;
    }
    if (m.lane >= static_cast<std::int64_t>(m.lanes.size())) {
      return m.missed == 0 ||
             Activity::fall_short(StepState::kBlocked, std::to_string(m.missed) + " of " +
                                                           std::to_string(m.lanes.size()) +
                                                           " lanes could not be driven");
    }
    if (phase_index() == kNext) {
      // From the end that is nearer.
      const Vec2 here = seen.X_WB.translation().head<2>();
      if ((lane().to.p - here).norm() < (lane().from.p - here).norm())
        std::swap(lane().from, lane().to);
      const PlanePose at = plane_pose(seen.X_WB);
      const bool there = (lane().from.p - here).norm() <= kHere &&
                         std::abs(std::remainder(at.yaw - lane().from.yaw, 2 * kPi)) <= kTurned;
      enter(there ? kRoll : kApproach);
      m.planned = !there && !is_straight(at);
      if (m.planned) {
        // From the other end, if only that lies straight ahead or behind.
        std::swap(lane().from, lane().to);
        m.planned = !is_straight(at);
        if (m.planned) std::swap(lane().from, lane().to);
      }
    }
    m.begin = seen.X_WB.translation().head<2>();
    make_part();
    part_->begin(seen);
    return false;
  }

  const Compact& step_;
  Part part_;
};

}  // namespace

std::vector<RollerLane> roller_lanes(const scene::Machine& machine,
                                     const std::vector<Vec2>& polygon, double yaw) {
  const Tracks tracks = tracks_of(machine);
  std::vector<RollerLane> out;
  if (tracks.bands.empty() || polygon.size() < 3) return out;
  Vec2 ahead = scene::longest_edge(polygon).normalized();
  if (ahead.dot(Vec2(std::cos(yaw), std::sin(yaw))) < 0) ahead = -ahead;
  const Vec2 across(-ahead.y(), ahead.x());
  const double infinite = std::numeric_limits<double>::infinity();
  double near = infinite, far = -infinite, low = infinite, high = -infinite;
  for (const Vec2& p : polygon) {
    near = std::min(near, p.dot(ahead));
    far = std::max(far, p.dot(ahead));
    low = std::min(low, p.dot(across));
    high = std::max(high, p.dot(across));
  }
  const double heading = std::atan2(ahead.y(), ahead.x());
  for (const double offset : offsets(tracks.bands, low, high))
    out.push_back({{(near - kBeyond - tracks.front) * ahead + offset * across, heading},
                   {(far + kBeyond - tracks.rear) * ahead + offset * across, heading}});
  return out;
}

void Compact::check(const scene::StepSource& source) {
  if (with == With::kWheels) {
    source.require(source.machine && source.machine->has_drive,
                   "compact needs a machine with <navvy:drive>");
    source.require(source.machine && !source.machine->wheels.empty(),
                   "compact needs a machine with wheels or tracks");
    if (source.has("press_n"))
      source.error("press_n", source.written("press_n"), "wheels roll with the machine's weight",
                   "remove it, or add <with>bucket</with>");
  } else {
    source.require(source.machine && !source.machine->arm.bucket.empty(),
                   "compact with the bucket needs a machine with <navvy:arm>");
    source.require(source.machine && !source.machine->buckets.empty(),
                   "compact with the bucket needs a machine with <navvy:bucket>");
    if (source.has("speed_m_per_s"))
      source.error("speed_m_per_s", source.written("speed_m_per_s"),
                   "the machine stands while it presses with the bucket", "remove it");
  }
  if (source.has("polygon_m"))
    if (const std::optional<scene::PolygonFault> fault =
            scene::polygon_of(polygon_numbers, polygon))
      source.error("polygon_m", fault->value, fault->rule, fault->remedy);
  for (const Vec2& corner : polygon) source.on_site("polygon_m", corner);
}

std::unique_ptr<Activity> Compact::activity(OperatorContext& place) const {
  if (with == With::kBucket) return bucket_press(place, *this);
  return std::make_unique<Rolling>(place, *this);
}

void Compact::check_reach(ReachCheck& check) const {
  if (with == With::kBucket) return check_bucket_press(*this, check);
  const std::vector<RollerLane> lanes =
      roller_lanes(check.machine, polygon, plane_pose(check.X_WB).yaw);
  const heightfield::Terrain& site = check.surface.terrain();
  for (const RollerLane& one : lanes)
    for (const PlanePose& end : {one.from, one.to}) {
      const Vec2i at = site.column_at(end.p.x(), end.p.y());
      if (site.contains(at.x(), at.y())) continue;
      check.fault("compact/polygon_m", place_text(end.p), "a lane begins or ends off the site",
                  "make the site larger, or roll a smaller area");
      return;
    }
  std::array<char, 80> line{};
  std::snprintf(line.data(), line.size(), "%zu lane%s of %d pass%s", lanes.size(),
                lanes.size() == 1 ? "" : "s", passes, passes == 1 ? "" : "es");
  check.note(line.data());
  if (lanes.empty()) return;
  const PlanePose& last = passes % 2 == 0 ? lanes.back().from : lanes.back().to;
  check.X_WB = make_pose(last.p.x(), last.p.y(), check.X_WB.translation().z(), 0, 0, last.yaw);
}

}  // namespace navvy::control
