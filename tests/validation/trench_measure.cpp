// SPDX-License-Identifier: Apache-2.0
#include "validation/trench_measure.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/error.h"

namespace navvy::validation {
namespace {

/// Half a metre around the design belongs to the dig; wheel ruts lie farther off.
constexpr double kAround = 0.5;

/// A point in the frame of the dig's line: s along it from its first end, t to its left.
struct OnLine {
  double s = 0, t = 0;
};

/// Frame of the dig's line.
struct Line {
  explicit Line(const control::Dig& dig)
      : from(dig.from),
        along((dig.to - dig.from).normalized()),
        length((dig.to - dig.from).norm()) {}
  OnLine at(const Vec2& p) const {
    return {(p - from).dot(along), (p - from).dot(Vec2(-along.y(), along.x()))};
  }

  Vec2 from, along;
  double length;
};

Vec2 middle_of(const heightfield::Ground& ground, int ix, int iy) {
  return ground.origin() + ground.cell() * Vec2(ix + 0.5, iy + 0.5);
}

bool belongs_to_dig(const OnLine& q, double length, double width) {
  return q.s >= -kAround && q.s <= length + kAround && std::abs(q.t) <= 0.5 * width + kAround;
}

/// Returns the share of the cell around p that is inside the design, by 5 x 5 points.
double covered(const Vec2& p, const Line& line, double cell, double width) {
  int inside = 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      const OnLine q = line.at(p + 0.2 * cell * Vec2(i, j));
      inside += q.s >= 0 && q.s <= line.length && std::abs(q.t) <= 0.5 * width ? 1 : 0;
    }
  return inside / 25.0;
}

/// Sums over a slice across the line, accumulated cell by cell.
struct Slice {
  double floor_sum = 0, floor_count = 0, moment = 0, removed = 0;
};

}  // namespace

control::Dig dig_step(const scene::Scene& world) {
  for (const scene::ProgramStep& step : world.machines.at(0).program.steps)
    if (const auto* dig = step.as<control::Dig>()) return *dig;
  throw SimulationError("the scene digs nothing");
}

TrenchMeasure measure(const heightfield::Ground& ground, const control::Dig& dig) {
  TrenchMeasure out;
  const Line line(dig);
  const double length = line.length, cell = ground.cell(), area = cell * cell;
  std::vector<Slice> slices(static_cast<std::size_t>(std::floor(length / cell)));
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double drop = ground.start_height(ix, iy) - ground.height(ix, iy);
      const OnLine q = line.at(middle_of(ground, ix, iy));
      if (!belongs_to_dig(q, length, dig.width)) continue;
      const double s = q.s, t = q.t,
                   inside = covered(middle_of(ground, ix, iy), line, cell, dig.width);
      out.inside_volume += area * inside * std::clamp(drop, 0.0, dig.depth);
      out.overdug +=
          area * (inside * std::max(drop - dig.depth, 0.0) + (1 - inside) * std::max(drop, 0.0));
      if (s < 0 || s >= cell * static_cast<double>(slices.size())) continue;
      Slice& slice = slices[static_cast<std::size_t>(s / cell)];
      if (drop > 0.5 * cell) slice.moment += drop * t, slice.removed += drop;
      // The floor is judged over the middle half of the width, clear of loose soil at the walls.
      if (std::abs(t) < 0.25 * dig.width) slice.floor_sum += drop, slice.floor_count += 1;
    }
  out.design_volume = length * dig.width * dig.depth;
  int good = 0;
  for (const Slice& slice : slices) {
    if (!(slice.floor_count > 0)) continue;
    const double depth = slice.floor_sum / slice.floor_count;
    if (std::abs(depth - dig.depth) <= 0.10) ++good;
    // Ends are ramps; the line is judged where at least half the depth was removed.
    if (depth > 0.5 * dig.depth)
      out.center_offset = std::max(out.center_offset, std::abs(slice.moment / slice.removed));
  }
  out.floor_share = good / static_cast<double>(slices.size());
  return out;
}

WheelTracks::WheelTracks(const heightfield::Ground& ground)
    : ground_(ground),
      marked_(static_cast<std::size_t>(ground.nx()) * static_cast<std::size_t>(ground.ny())) {}

void WheelTracks::mark(const sim::World& world) {
  const auto& wheels = world.description().machines.at(0).machine.wheels;
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    const Vec3 center =
        world.machines().at(0).wheel(static_cast<int>(w)).state().X_WWheel.translation();
    const double reach = 0.5 * (wheels[w].twin_spacing + wheels[w].width) + ground_.cell();
    const Vec2i low = ground_.column_at(center.x() - reach, center.y() - reach);
    const Vec2i high = ground_.column_at(center.x() + reach, center.y() + reach);
    for (int iy = std::max(low.y(), 0); iy <= std::min(high.y(), ground_.ny() - 1); ++iy)
      for (int ix = std::max(low.x(), 0); ix <= std::min(high.x(), ground_.nx() - 1); ++ix)
        if ((middle_of(ground_, ix, iy) - center.head<2>()).norm() <= reach)
          marked_[static_cast<std::size_t>(iy) * static_cast<std::size_t>(ground_.nx()) +
                  static_cast<std::size_t>(ix)] = 1;
  }
}

bool WheelTracks::hold(int ix, int iy) const {
  return marked_[static_cast<std::size_t>(iy) * static_cast<std::size_t>(ground_.nx()) +
                 static_cast<std::size_t>(ix)] != 0;
}

double spoil_radius(double loose_volume, double repose, double width) {
  return std::cbrt(3 * loose_volume / (kPi * std::tan(repose))) + 0.5 * width;
}

std::vector<double> heap_slopes(const heightfield::Ground& ground, const control::Dig& dig,
                                double spoil_radius) {
  constexpr double kOver = 0.6, kRisen = 0.35;
  const int straight = static_cast<int>(std::lround(kOver / ground.cell()));
  const int across = static_cast<int>(std::lround(kOver / std::sqrt(2.0) / ground.cell()));
  std::vector<double> out;
  for (int iy = straight; iy < ground.ny() - straight; ++iy)
    for (int ix = straight; ix < ground.nx() - straight; ++ix) {
      const double height = ground.height(ix, iy);
      if ((middle_of(ground, ix, iy) - dig.dump_at).norm() > spoil_radius) continue;
      if (height - ground.start_height(ix, iy) < kRisen) continue;
      double steepest = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          if (dx == 0 && dy == 0) continue;
          const int steps = dx != 0 && dy != 0 ? across : straight;
          const double distance = ground.cell() * steps * std::hypot(dx, dy);
          steepest = std::max(
              steepest, (height - ground.height(ix + steps * dx, iy + steps * dy)) / distance);
        }
      out.push_back(degrees(std::atan(steepest)));
    }
  std::sort(out.begin(), out.end());
  return out;
}

namespace {

/// Calls `use` with the change of height [m] of each column outside the trench, the spoil and the
/// tracks.
template <class Use>
void visit_elsewhere(const heightfield::Ground& ground, const control::Dig& dig,
                     double spoil_radius, const WheelTracks& tracks, Use use) {
  const Line line(dig);
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const Vec2 p = middle_of(ground, ix, iy);
      if (belongs_to_dig(line.at(p), line.length, dig.width) ||
          (p - dig.dump_at).norm() < spoil_radius || tracks.hold(ix, iy))
        continue;
      use(ground.height(ix, iy) - ground.start_height(ix, iy));
    }
}

}  // namespace

double volume_elsewhere(const heightfield::Ground& ground, const control::Dig& dig,
                        double spoil_radius, const WheelTracks& tracks) {
  double sum = 0;
  visit_elsewhere(ground, dig, spoil_radius, tracks,
                  [&](double change) { sum += std::max(0.0, change); });
  return sum * ground.cell() * ground.cell();
}

double change_elsewhere(const heightfield::Ground& ground, const control::Dig& dig,
                        double spoil_radius, const WheelTracks& tracks) {
  double most = 0;
  visit_elsewhere(ground, dig, spoil_radius, tracks,
                  [&](double change) { most = std::max(most, std::abs(change)); });
  return most;
}

}  // namespace navvy::validation
