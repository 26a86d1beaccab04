// SPDX-License-Identifier: Apache-2.0
#include "control/dig_plan.h"

#include <algorithm>
#include <cmath>

namespace navvy::control {
namespace {

constexpr double kTolerance = 0.06;  // what counts as dug to level [m]; tuned: Trench.IsDugToItsDesign
constexpr double kSample = 0.1;      // along the line [m]

}  // namespace

TrenchLine trench_line(const scene::Dig& dig, const Pose& X_WS) {
  const auto plan = [&](const Vec2& p) {
    const Vec3 q = X_WS.inverse() * Vec3(p.x(), p.y(), X_WS.translation().z());
    return Vec2(q.x(), q.y());
  };
  const Vec2 a = plan(dig.from), b = plan(dig.to);
  const bool from_is_far = a.norm() >= b.norm();
  TrenchLine line;
  line.far = from_is_far ? dig.from : dig.to;
  line.near = from_is_far ? dig.to : dig.from;
  const Vec2 far = from_is_far ? a : b, near = from_is_far ? b : a;
  const Vec2 u = (far - near).normalized();
  line.offset = std::abs(near.x() * u.y() - near.y() * u.x());
  line.far_reach = far.dot(u);
  line.near_reach = near.dot(u);
  line.swing = std::atan2(u.y(), u.x());
  return line;
}

DigPlan::DigPlan(const scene::Dig& dig, const TrenchLine& line, const heightfield::Ground& ground)
    : dig_(dig), line_(line) {
  const int n = std::max(2, static_cast<int>(std::lround((line.far_reach - line.near_reach) / kSample)) + 1);
  for (int i = 0; i < n; ++i) {
    const double reach = line.near_reach + (line.far_reach - line.near_reach) * i / (n - 1);
    start_.push_back(height(ground, reach));
  }
}

Vec2 DigPlan::point(double reach) const {
  const double t = (reach - line_.near_reach) / (line_.far_reach - line_.near_reach);
  return line_.near + t * (line_.far - line_.near);
}

double DigPlan::height(const heightfield::Ground& ground, double reach) const {
  // Mean of three points across the middle of the cut.
  const Vec2 u = (line_.far - line_.near).normalized(), across(-u.y(), u.x());
  double sum = 0;
  for (const double t : {-0.25, 0.0, 0.25}) {
    const Vec2 p = point(reach) + t * dig_.width * across;
    sum += ground.sample(p.x(), p.y());
  }
  return sum / 3;
}

double DigPlan::start_height(double reach) const {
  const double t = (reach - line_.near_reach) / (line_.far_reach - line_.near_reach) * (samples() - 1);
  const double c = std::clamp(t, 0.0, samples() - 1.0);
  const auto i = static_cast<std::size_t>(std::min(samples() - 2, static_cast<int>(c)));
  return start_[i] + (c - static_cast<double>(i)) * (start_[i + 1] - start_[i]);
}

double DigPlan::remaining(const heightfield::Ground& ground, double reach, double level) const {
  return height(ground, reach) - (start_height(reach) - level);
}

double DigPlan::fill_end(const heightfield::Ground& ground, const Scoop& scoop, double bank_volume) const {
  double volume = 0;
  for (double reach = scoop.start; reach > scoop.end; reach -= kSample) {
    volume += std::max(0.0, remaining(ground, reach, scoop.level)) * dig_.width * kSample;
    if (volume >= bank_volume) return reach;
  }
  return scoop.end;
}

Scoop DigPlan::next(const heightfield::Ground& ground) const {
  const int n = samples();
  const auto reach_of = [&](int i) { return line_.near_reach + (line_.far_reach - line_.near_reach) * i / (n - 1); };
  for (double level = dig_.pass_depth;; level += dig_.pass_depth) {
    const double target = std::min(level, dig_.depth);
    for (int i = n - 1; i >= 0; --i) {
      // Two neighbours must agree, a single crumb is not worth a cycle.
      const int j = std::max(0, i - 1);
      if (remaining(ground, reach_of(i), target) > kTolerance && remaining(ground, reach_of(j), target) > kTolerance)
        return {reach_of(i), line_.near_reach, target, true};
    }
    if (target >= dig_.depth) return {};
  }
}

void DigPlan::save(StateWriter& writer) const {
  for (const Vec2& p : {dig_.from, dig_.to, dig_.dump_at, line_.near, line_.far}) writer.vec3(Vec3(p.x(), p.y(), 0));
  for (const double v : {dig_.depth, dig_.width, dig_.dump_height, dig_.pass_depth, line_.near_reach, line_.far_reach,
                         line_.swing, line_.offset})
    writer.value(v);
  writer.vector(start_);
}

void DigPlan::load(StateReader& reader) {
  for (Vec2* p : {&dig_.from, &dig_.to, &dig_.dump_at, &line_.near, &line_.far}) *p = reader.vec3().head<2>();
  for (double* v : {&dig_.depth, &dig_.width, &dig_.dump_height, &dig_.pass_depth, &line_.near_reach, &line_.far_reach,
                    &line_.swing, &line_.offset})
    *v = reader.value<double>();
  start_ = reader.vector<double>();
}

}  // namespace navvy::control
