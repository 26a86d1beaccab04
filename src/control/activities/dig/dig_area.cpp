// SPDX-License-Identifier: Apache-2.0
// The dig_area step as a scene describes it; area_digging.h carries it out.
#include "control/activities/dig/dig_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

#include "control/activities/dig/area_digging.h"
#include "control/arm_kinematics.h"
#include "control/reach.h"
#include "scene/polygon.h"

namespace navvy::control {
namespace {

/// Returns the two points of 4 numbers; nothing for another number of them.
std::vector<Vec2> ends_of(const std::vector<double>& numbers) {
  if (numbers.size() != 4) return {};
  return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

}  // namespace

void DigArea::check(const scene::StepSource& source) {
  const scene::Machine* machine = source.machine;
  // The same parts as a dig and a drive need.
  const bool can = machine && !machine->buckets.empty() && !machine->arm.boom.empty() &&
                   !machine->arm.stick.empty() && !machine->arm.bucket.empty();
  source.require(can,
                 (element() + std::string(" needs a machine with <navvy:bucket> and <navvy:arm> "
                                          "(boom, stick, bucket)"))
                     .c_str());
  source.require(!needs_planner() || (machine && machine->has_drive),
                 (element() + std::string(" needs a machine with <navvy:drive>")).c_str());
  std::istringstream names(into_names);
  into.assign(std::istream_iterator<std::string>(names), {});
  if (has_load != !into.empty())
    source.error(has_load ? "load_kg" : "into", has_load ? source.written("load_kg") : into_names,
                 "a job that loads trucks needs both their names and the mass of a load",
                 "give <into> and <load_kg>, or neither");
  if (source.has("polygon_m"))
    if (const std::optional<scene::PolygonFault> fault =
            scene::polygon_of(polygon_numbers, polygon))
      source.error("polygon_m", fault->value, fault->rule, fault->remedy);
  source.on_site("dump_at_m", dump_at);
  if (has_dump_to) source.on_site("dump_to_m", dump_to);
  const std::size_t numbers = second_windrow.size();
  if (numbers != 0 && numbers != 4)
    source.error("second_windrow_m", source.written("second_windrow_m"), "must be 4 numbers",
                 "write x y of one end, then x y of the other");
  for (const Vec2& p : ends_of(second_windrow)) source.on_site("second_windrow_m", p);
  double deepest = depth;
  for (const Vec2& p : polygon)
    deepest = std::max(
        deepest,
        depth + std::tan(fall) *
                    (p - polygon.front()).dot(Vec2(std::cos(fall_yaw), std::sin(fall_yaw))));
  if (source.ground && deepest > source.ground->depth)
    source.error("depth_m", source.written("depth_m"), "must not exceed depth_m of the ground",
                 "there is rock below; make the ground deeper");
}

std::optional<scene::DesignArea> DigArea::area() const {
  if (polygon.empty()) return std::nullopt;
  scene::DesignArea out;
  out.polygon = polygon;
  out.polygon_numbers = polygon_numbers;
  out.depth = depth;
  out.batter = batter;
  out.fall = fall;
  out.fall_yaw = fall_yaw;
  return out;
}

std::vector<Vec2> DigArea::places() const {
  std::vector<Vec2> out = polygon;
  out.push_back(dump_at);
  if (has_dump_to) out.push_back(dump_to);
  for (const Vec2& p : ends_of(second_windrow)) out.push_back(p);
  return out;
}

PitJob DigArea::job() const {
  const std::vector<Vec2> second = ends_of(second_windrow);
  return {area().value_or(scene::DesignArea{}),
          dump_at,
          has_dump_to ? dump_to : dump_at,
          second.empty() ? std::nullopt : std::optional(std::array{second[0], second[1]}),
          dump_height,
          pass_depth,
          tolerance,
          heap,
          !into.empty(),
          over};
}

std::unique_ptr<Activity> DigArea::activity(OperatorContext& place) const {
  return std::make_unique<AreaDigging>(place, *this);
}

void DigArea::check_reach(ReachCheck& check) const {
  if (!check.jobs) {
    check.fault(element(), "", "nobody plans jobs here",
                "hand a job planner to the operator, or dig single trenches");
    return;
  }
  const JobPlan plan = check.jobs->plan(job(), check.X_WB, check.surface);
  for (const JobFault& one : plan.faults) {
    const std::string part = std::string(element()) + "/" + one.part;
    if (one.error)
      check.fault(part, one.value, one.rule, one.remedy);
    else
      check.warn(part, one.value, one.rule, one.remedy);
  }
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "%.2f m3 from %zu station%s", plan.volume,
                plan.stations.size(), plan.stations.size() == 1 ? "" : "s");
  check.note(line.data());
  for (std::size_t i = 0; i < plan.stations.size(); ++i) {
    const JobStation& one = plan.stations[i];
    std::snprintf(line.data(), line.size(),
                  "station %zu at (%.2f, %.2f) m, heading %.0f deg: %lld cuts, %.2f m3", i + 1,
                  one.at.p.x(), one.at.p.y(), degrees(one.at.yaw), static_cast<long long>(one.cuts),
                  one.volume);
    check.note(line.data());
  }
  if (plan.stations.empty()) return;
  // The steps after this one begin at the last station.
  const PlanePose& last = plan.stations.back().at;
  const double rise =
      check.X_WB.translation().z() -
      check.surface.height(check.X_WB.translation().x(), check.X_WB.translation().y());
  check.X_WB = make_pose(last.p.x(), last.p.y(),
                         check.surface.height(last.p.x(), last.p.y()) + rise, 0, 0, last.yaw);
}

}  // namespace navvy::control
