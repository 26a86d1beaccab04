// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/activation_rules.h"

#include <algorithm>
#include <cmath>

namespace navvy::soil {
namespace {

// Size of the zone in dig depths, and the smallest dig depth [docs/exchange.md, activation].
constexpr double kAhead = 2, kSides = 1, kLeastDepthCells = 2;
/// Soil within this distance of a tool stays particles [cells] [docs/exchange.md, deposit].
constexpr int kToolGuard = 2;
/// A tool slower than this has no direction and no speed to take a share of [m/s]. Tuned with scene
/// `trench`, where a bucket at rest must keep its active soil.
constexpr double kSlowTool = 0.1;
/// Depth below a tool to which soil that it drags along activates columns [cells]. Soil fails
/// upwards from the edge, and one cell of depth gives the same force as many
/// [docs/exchange.md, activation].
constexpr double kDeepest = 3;
/// A cut column ends within a mass quantum of the height asked for; this is above that [cells].
constexpr double kCutError = 1e-3;
// Motion at the border of active soil: share of the tool's speed, speed without a tool, and the
// minimum, below which ringing activates everything [m/s]. Tuned: with a minimum of 0.02 a blade in
// loam has a tenth more particles before it, at the same force.
constexpr double kMotionShare = 0.05, kMotionDefault = 0.05, kMotionFloor = 0.05;
// Soil with less plastic shear than this has not failed: its motion is an elastic wave
// [docs/exchange.md, activation]. Tuned: a heap that slides beside a deep trench activates 42 000,
// 40 000 and 26 000 particles at 0.02, 0.1 and 0.5.
constexpr float kUnfailed = 0.05F;

// Returns the columns that the interval [low, high] of W covers, with `margin` cells around.
heightfield::CellRect columns_of(const heightfield::Ground& ground, const Vec2& low,
                                 const Vec2& high, double margin) {
  const auto bounded = [](double v, int n) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(n)));
  };
  // Round numbers lie on the edges of columns. They must round the same way everywhere on the site.
  const Vec2 nudge = Vec2::Constant(1e-6);
  const Vec2 a = (low - ground.origin()) / ground.cell() + nudge,
             b = (high - ground.origin()) / ground.cell() + nudge;
  return {bounded(std::floor(a.x() - margin), ground.nx()),
          bounded(std::floor(a.y() - margin), ground.ny()),
          bounded(std::floor(b.x() + margin) + 1, ground.nx()),
          bounded(std::floor(b.y() + margin) + 1, ground.ny())};
}

double height_in_cells(const heightfield::Ground& ground, int ix, int iy) {
  return (ground.height(ix, iy) - ground.datum()) / ground.cell();
}

// Returns the mean height of resting and loose soil over a rectangle [cells above datum]. A mean,
// as single columns beside a tool stand high or low.
double mean_surface(const heightfield::Ground& ground, const ColumnIndex& index,
                    const heightfield::CellRect& rect) {
  double sum = 0;
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix)
      sum += height_in_cells(ground, ix, iy) + index.pile_height(ix, iy);
  return rect.empty() ? 0 : sum / (static_cast<double>(rect.x1 - rect.x0) * (rect.y1 - rect.y0));
}

}  // namespace

std::vector<ToolZone> tool_zones(const heightfield::Ground& ground, const ColumnIndex& index,
                                 std::span<const ToolRegion> tools, double scale) {
  std::vector<ToolZone> zones;
  const double cell = ground.cell();
  for (const ToolRegion& tool : tools) {
    ToolZone out;
    out.scale = scale;
    const Vec2 low = tool.min.head<2>(), high = tool.max.head<2>();
    out.low = (tool.min.z() - ground.datum()) / cell;
    out.high = (tool.max.z() - ground.datum()) / cell;
    out.speed = tool.velocity.norm();
    out.box = columns_of(ground, low, high, 0);
    out.tool = tool.tool;
    out.supported = tool.supported;
    if (tool.supported) {
      zones.push_back(out);
      continue;
    }
    out.near = columns_of(ground, low, high, kToolGuard);

    // Dig depth below the soil around the tool; soil higher than the tool is not pushed by it.
    const heightfield::CellRect around = columns_of(ground, low, high, 1);
    const double most = std::max(out.high - out.low, 0.0) + kLeastDepthCells;
    const double depth =
        std::clamp(mean_surface(ground, index, around) - out.low, kLeastDepthCells, most);
    Vec2 ahead = Vec2::Zero();
    const Vec2 v = tool.velocity.head<2>();
    // A tool that hardly moves has no direction; its zone is equal on all sides.
    if (v.norm() > kSlowTool) ahead = v * (scale * kAhead * depth * cell / v.norm());
    const Vec2 sides = Vec2::Constant(scale * kSides * depth * cell);
    // The box grows by two depths along the motion and by one elsewhere, per axis, so that a tool
    // that moves diagonally gets both.
    const Vec2 zone_low = low - sides.cwiseMax(-ahead), zone_high = high + sides.cwiseMax(ahead);
    out.zone = columns_of(ground, zone_low, zone_high, 0);

    // One column is enough. The search ends there, as most tools of a machine hang in the air.
    for (int iy = out.zone.y0; iy < out.zone.y1 && !out.engaged; ++iy)
      for (int ix = out.zone.x0; ix < out.zone.x1 && !out.engaged; ++ix)
        out.engaged = height_in_cells(ground, ix, iy) + index.pile_height(ix, iy) > out.low - 1;
    zones.push_back(out);
  }
  return zones;
}

void plan_activation(ActivationPlan& plan, int ix, int iy, double bottom) {
  // Two rules may ask for one column: the deeper request remains.
  const auto [found, is_new] = plan.emplace(PlanKey{iy, ix}, bottom);
  if (!is_new) found->second = std::min(found->second, bottom);
}

void activate_ahead_of_tools(const heightfield::Ground& ground, std::span<const ToolZone> zones,
                             ActivationPlan& plan) {
  for (const ToolZone& tool : zones) {
    if (!tool.engaged) continue;
    for (int iy = tool.zone.y0; iy < tool.zone.y1; ++iy)
      for (int ix = tool.zone.x0; ix < tool.zone.x1; ++ix)
        if (height_in_cells(ground, ix, iy) > tool.low - tool.scale + kCutError)
          plan_activation(plan, ix, iy, std::floor(tool.low) - std::round(tool.scale));
  }
}

double motion_threshold(std::span<const ToolZone> zones) {
  // The slowest, so that soil before a slow blade becomes active beside a fast one.
  double slowest = 0;
  for (const ToolZone& tool : zones)
    if (tool.engaged && tool.speed > kSlowTool)
      slowest = slowest == 0 ? tool.speed : std::min(slowest, tool.speed);
  return slowest == 0 ? kMotionDefault : std::max(kMotionShare * slowest, kMotionFloor);
}

bool lowest_motion(const ColumnIndex& index, std::span<const std::uint32_t> column,
                   double threshold, int& cell) {
  for (const std::uint32_t i : column) {
    const Particle& p = index[i];
    // In doubles, so that a speed at the threshold is judged the same way everywhere. A NaN is not
    // below it and counts as motion.
    const double square = static_cast<double>(p.v[0]) * p.v[0] +
                          static_cast<double>(p.v[1]) * p.v[1] +
                          static_cast<double>(p.v[2]) * p.v[2];
    if (square <= threshold * threshold || p.shear < kUnfailed) continue;
    cell = static_cast<int>(std::floor(soil::height_in_cells(p)));
    return true;
  }
  return false;
}

bool activates_beside(const heightfield::Ground& ground, std::span<const ToolZone> zones, int ix,
                      int iy, int cell, double& bottom) {
  // Two cells below the motion, and at least one below the column's own top, so that a thin crust
  // is taken whole.
  const double h = height_in_cells(ground, ix, iy);
  bottom = std::min(static_cast<double>(cell) - 2, std::floor(h) - 1);
  // A tool drags soil along below it; without this limit every check would activate a cell more.
  for (const ToolZone& tool : zones)
    if (tool.engaged && ToolZone::contains(tool.zone, ix, iy))
      bottom = std::max(bottom, std::floor(tool.low) - std::round(tool.scale * kDeepest));
  // The motion does not touch columns that end more than a cell below it.
  return h > cell - 1 + kCutError && h > bottom + kCutError;
}

}  // namespace navvy::soil
