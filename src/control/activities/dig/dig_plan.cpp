// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dig/dig_plan.h"

#include <algorithm>
#include <cmath>

namespace navvy::control {
namespace {

constexpr double kOnFloor = 0.1;     // soil above a floor that counts as down [m]
constexpr double kTolerance = 0.05;  // what counts as dug to level: half a soil cell [m]
constexpr double kSample = 0.1;      // along the line [m]
// Length given up before a scoop's start when it brings nothing [m].
constexpr double kRefused = 0.4;
// A scoop begins at least this far from the near end if the slice is dug there: the edge needs
// distance to fill the bucket and to cut on while it curls [m].
constexpr double kLeastRun = 1.6;
// A scoop whose soil begins behind finished floor starts this far before it, so that the bucket has
// turned to its digging angle when it fills [m].
constexpr double kTurnRun = 0.7;
// A pass along the floor leaves this share of the soil on it, spread thin towards the far end.
constexpr double kLeftBehind = 0.06;
// The ramp that the curl leaves at the near end, which a pass along the floor does not take [m].
constexpr double kRamp = 0.4;
// Mean length of that ramp [m], and the largest factor by which upper slices are thicker for it.
constexpr double kRampShare = 0.3, kMostShift = 1.2;
// A pass along the floor keeps clear of the far wall by this [m].
constexpr double kFarClear = 0.1;
// Share of a cut's width, about its middle: at the sides columns are dug in part.
constexpr double kInside = 0.8;
constexpr int kStripes = 5;         // across the whole width of a trench
constexpr double kBeside = 0.5;     // how far beside the cut spilt soil is looked for [m]
constexpr double kOverload = 0.15;  // a load may be larger than a full bucket by this share of it
constexpr double kThinner = 0.7;    // a slice after one that held the bucket, of that one
constexpr double kThinnest = 0.1;   // what the soil's cells still resolve [m]
// The rest of a slice below this share of a bucket waits for the next slice.
constexpr double kWorth = 0.7;
// The rest of the last slice below this share of a bucket stays, but no more than this share of the
// trench.
constexpr double kWorthLast = 0.15, kMostRest = 0.05;
// A scoop starts where this share of its slice still stands over this length [m]; less is taken
// along by a later scoop or by the clean-up.
constexpr double kStands = 0.4, kStandsFor = 0.6;

}  // namespace

TrenchLine trench_line(const Dig& dig, const Pose& X_WS) {
  // Which end is far, and where the line is, are seen in plan from the swing axis, as the arm works
  // in planes through it.
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

DigPlan::DigPlan(const Dig& dig, const TrenchLine& line, double scoop_volume,
                 const SurfaceView& surface)
    : dig_(dig), line_(line), scoop_volume_(scoop_volume) {
  derive();
  start_.resize(
      static_cast<std::size_t>(std::max(2, static_cast<int>(std::lround(length_ / kSample)) + 1)));
  for (int i = 0; i < samples(); ++i) start_[static_cast<std::size_t>(i)] = height(surface, at(i));
  // Nothing has been refused yet.
  deepest_.assign(start_.size(), dig.depth);
  if (!dig_.is_cut()) return;
  for (int i = 0; i < samples(); ++i) deepest_[static_cast<std::size_t>(i)] = floor_depth(i);
  dig_.depth = std::max(kTolerance, *std::max_element(deepest_.begin(), deepest_.end()));
}

double DigPlan::floor_depth(int i) const {
  if (!dig_.is_cut()) return dig_.depth;
  return std::max(0.0, start_[static_cast<std::size_t>(i)] - between(dig_.floor, at(i)));
}

double DigPlan::floor_height(double s, double level) const {
  const double pass = start_height(s) - level;
  return dig_.is_cut() ? std::max(pass, between(dig_.floor, s)) : pass;
}

double DigPlan::design_volume() const {
  if (!dig_.is_cut()) return length_ * dig_.width * dig_.depth;
  double sum = 0;
  // The first sample has no piece before it, as in volume_above.
  for (int i = 1; i < samples(); ++i)
    sum += floor_depth(i) * dig_.width * length_ / (samples() - 1);
  return sum;
}

void DigPlan::derive() {
  // All distances along the trench count from its near end outward.
  length_ = std::max(kSample, (line_.far - line_.near).norm());
  along_ = (line_.far - line_.near) / length_;
}

double DigPlan::height(const SurfaceView& surface, double s) const {
  const Vec2 across(-along_.y(), along_.x());
  double sum = 0;
  if (dig_.is_cut()) {
    // Nearly the whole width, down to the floor: strips beside this one have dug into it.
    const double floor = between(dig_.floor, s);
    for (int k = 0; k < kStripes; ++k) {
      const Vec2 p = point(s) + kInside * ((k + 0.5) / kStripes - 0.5) * dig_.width * across;
      sum += std::max(floor, surface.height(p.x(), p.y()));
    }
    return sum / kStripes;
  }
  // Mean of three points across the middle of the cut: loose particles at the walls do not count.
  for (const double t : {-0.25, 0.0, 0.25}) {
    const Vec2 p = point(s) + t * dig_.width * across;
    sum += surface.height(p.x(), p.y());
  }
  return sum / 3;
}

double DigPlan::highest_beside(const SurfaceView& surface, double s) const {
  const Vec2 across(-along_.y(), along_.x());
  // From the wall outward, on both sides.
  double out = dig_.is_cut() ? std::max(dig_.rim, start_height(s)) : start_height(s);
  for (int i = 0; i * kSample <= kBeside + 1e-9; ++i)
    for (const double side : {-1.0, 1.0}) {
      const Vec2 p = point(s) + side * (0.5 * dig_.width + i * kSample) * across;
      out = std::max(out, surface.height(p.x(), p.y()));
    }
  return out;
}

double DigPlan::start_height(double s) const { return between(start_, s); }

double DigPlan::between(const std::vector<double>& values, double s) const {
  // Linear between samples, constant beyond the ends.
  const int n = static_cast<int>(values.size());
  const double t = std::clamp(s / length_ * (n - 1), 0.0, n - 1.0);
  const auto i = static_cast<std::size_t>(std::min(n - 2, static_cast<int>(t)));
  return values[i] + (t - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

double DigPlan::remaining(const SurfaceView& surface, int i, double level) const {
  // Soil below a refused depth does not count as left.
  const auto k = static_cast<std::size_t>(i);
  return height(surface, at(i)) - start_[k] + std::min(level, deepest_[k]);
}

void DigPlan::refuse(const SurfaceView& surface, double s) {
  for (int i = 0; i < samples(); ++i) {
    // Half as far behind the start as ahead of it, because the scoop moved that way.
    if (at(i) > s + 0.5 * kRefused || at(i) < s - kRefused) continue;
    const auto k = static_cast<std::size_t>(i);
    deepest_[k] = std::min(deepest_[k], start_[k] - height(surface, at(i)));
  }
}

int DigPlan::slices() const {
  return std::max(1, static_cast<int>(std::ceil(dig_.depth / dig_.pass_depth - 1e-9)));
}

int DigPlan::loads() const {
  return std::max(slices(),
                  static_cast<int>(std::ceil(design_volume() / scoop_volume_ - kOverload)));
}

double DigPlan::level_of(int k) const {
  const double even =
      dig_.depth * std::round(static_cast<double>(loads()) * k / slices()) / loads();
  if (k >= slices()) return even;
  // What the curls of the upper slices leave at the near end is dug with the last slice.
  const double ramps = std::min(kMostShift, length_ / std::max(kSample, length_ - kRampShare));
  return std::max(even, std::min(ramps * even, k * dig_.pass_depth));
}

double DigPlan::least_rest() const {
  return std::min(kWorthLast * scoop_volume_, kMostRest * design_volume());
}

Scoop DigPlan::clean_up(const SurfaceView& surface, bool hindered) const {
  // From the farthest soil that a pass can take without wearing the far wall.
  int i = samples() - 1;
  double passed = 0;
  const double left = kLeftBehind * volume_on_floor(surface);
  while (i > 1 && (at(i) > length_ - kFarClear + 1e-9 || passed < left ||
                   !stands(surface, i, dig_.depth, kTolerance)))
    passed += piece_above(surface, i--, dig_.depth);
  const double start = at(run_up(surface, i, dig_.depth, kTolerance, hindered));
  const bool any = volume_on_floor(surface) > least_rest() || state(surface).is_rough();
  return {start, 0, at(i), dig_.depth, any};
}

bool DigPlan::thin() {
  if (dig_.pass_depth <= kThinnest) return false;
  dig_.pass_depth = std::max(kThinnest, kThinner * dig_.pass_depth);
  return true;
}

double DigPlan::piece_above(const SurfaceView& surface, int i, double level) const {
  return std::max(0.0, remaining(surface, i, level)) * dig_.width * length_ / (samples() - 1);
}

double DigPlan::volume_above(const SurfaceView& surface, double level) const {
  // The first sample has no piece before it.
  double sum = 0;
  for (int i = 1; i < samples(); ++i) sum += piece_above(surface, i, level);
  return sum;
}

TrenchState DigPlan::state(const SurfaceView& surface) const {
  // Over the whole width, where `height` samples the middle: soil that is left is left at the walls
  // too.
  const Vec2 across(-along_.y(), along_.x());
  // The first sample has no piece before it, as in volume_above.
  const double piece = dig_.width / kStripes * length_ / (samples() - 1);
  TrenchState out;
  std::vector<double> depths;
  for (int i = 0; i < samples(); ++i) {
    const double before = start_[static_cast<std::size_t>(i)];
    const double commanded = floor_depth(i);
    depths.push_back(before - height(surface, at(i)));
    if (depths.back() > commanded - kOnFloor) out.floor += 1.0 / samples();
    for (int k = 0; i > 0 && k < kStripes; ++k) {
      const Vec2 p = point(at(i)) + ((k + 0.5) / kStripes - 0.5) * dig_.width * across;
      out.left +=
          piece * std::clamp(commanded - before + surface.height(p.x(), p.y()), 0.0, commanded);
    }
  }
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  out.depth = *middle;
  return out;
}

double DigPlan::fill_end(const SurfaceView& surface, int start, double level) const {
  // The rest of the slice is divided into equal loads: a short last scoop wears the walls as much
  // as a long one.
  const double rest = volume_above(surface, level);
  const double load = rest / std::max(1.0, std::ceil(rest / scoop_volume_ - kOverload));
  double volume = 0;
  // From the far end on, piece by piece, until the load is full.
  for (int i = start; i > 0; --i) {
    volume += piece_above(surface, i, level);
    if (volume >= load) return at(i);
  }
  return 0;
}

int DigPlan::run_up(const SurfaceView& surface, int i, double level, double least,
                    bool hindered) const {
  // Back over the floor of the slice and what lies thin on it; undiggable soil ends it.
  const double least_start = std::max(kLeastRun, hindered ? 0 : at(i) + kTurnRun);
  for (; i + 1 < samples() && at(i) < least_start - 1e-9; ++i)
    if (height(surface, at(i + 1)) >
        start_[static_cast<std::size_t>(i + 1)] - std::min(level, floor_depth(i + 1)) + least)
      break;
  return i;
}

bool DigPlan::stands(const SurfaceView& surface, int i, double level, double least) const {
  // Two neighbours must agree, as a single loose particle is not worth a cycle.
  if (remaining(surface, i, level) <= least || remaining(surface, i - 1, level) <= least)
    return false;
  if (least <= kTolerance) return true;
  // What a wall has shed covers a short length only.
  double sum = 0;
  int count = 0;
  for (int k = i; k >= 0 && at(i) - at(k) < kStandsFor; --k, ++count)
    sum += std::max(0.0, remaining(surface, k, level));
  return sum > least * count;
}

double DigPlan::volume_on_floor(const SurfaceView& surface) const {
  double sum = 0;
  for (int i = 1; i < samples(); ++i)
    if (at(i) > std::min(kRamp, 0.25 * length_)) sum += piece_above(surface, i, dig_.depth);
  return sum;
}

Scoop DigPlan::next(const SurfaceView& surface, bool hindered) const {
  // The next slice starts only when the one above holds no worthwhile load.
  double above = 0;
  for (int k = 1; k <= slices(); ++k) {
    const double level = level_of(k), thick = std::max(kTolerance, kStands * (level - above));
    const double rest = volume_above(surface, level);
    above = level;
    // What is left of the last slice, if no more than a load, is the clean-up's.
    const double worth = k < slices() ? kWorth : dig_.is_cut() ? dig_.worth : 1 + kOverload;
    if (rest < worth * scoop_volume_) continue;
    // A scoop begins behind what lies thin on the floor, unless nothing else is left.
    for (const double least : {thick, kTolerance})
      for (int i = samples() - 1; i >= 1; --i)
        if (stands(surface, i, level, least))
          return {at(run_up(surface, i, level, least, hindered)), fill_end(surface, i, level),
                  at(i), level, true};
  }
  return {};
}

void TrenchLine::visit(Archive& a) {
  a("near", near);
  a("far", far);
  a("near_reach", near_reach);
  a("far_reach", far_reach);
  a("swing", swing);
  a("offset", offset);
}

void DigPlan::visit(Archive& a) {
  // The trench as commanded when the dig began: a scene that has changed since does not alter a
  // plan in progress.
  a("from", dig_.from);
  a("to", dig_.to);
  a("dump_at", dig_.dump_at);
  a("depth", dig_.depth);
  a("width", dig_.width);
  a("dump_height", dig_.dump_height);
  a("pass_depth", dig_.pass_depth);
  a("line", line_);
  a("scoop_volume", scoop_volume_);
  a("start", start_);
  a("deepest", deepest_);
  // One of each per sample, and at least two samples; or none at all, where no plan has been made.
  a.require(deepest_.size() == start_.size() && start_.size() != 1, "deepest",
            "has not one depth for each sample");
  if (a.loading() && !start_.empty()) derive();
}

}  // namespace navvy::control
