// SPDX-License-Identifier: Apache-2.0
// The trench: the shipped scene from start to end, measured on the ground it leaves (issue 2, "How it is shown").
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "device/device.h"
#include "record/summary.h"
#include "scene_io/loader.h"
#include "sim/session.h"
#include "validation/report.h"

namespace navvy::validation {
namespace {

/// The dig step of the only machine.
scene::Dig dig_step(const scene::World& world) {
  for (const scene::ProgramStep& step : world.machines.at(0).program.steps)
    if (const auto* dig = std::get_if<scene::Dig>(&step)) return *dig;
  ADD_FAILURE() << "the scene digs nothing";
  return {};
}

/// Terrain end minus start inside and outside the design.
struct TrenchMeasure {
  double inside_volume = 0;  ///< removed within the design's outline [m3]
  double design_volume = 0;  ///< outline x depth [m3]
  double overdug = 0;        ///< removed below the design floor or beside the outline by the bucket [m3]
  double floor_share = 0;    ///< share of the length whose floor is within 0.10 m of the design
  double center_offset = 0;  ///< largest over the length of |centre of removed area - design line| [m]
};

/// Share of a cell around p (in the line's frame: s along, t across) that lies inside the design, by 5 x 5 points.
double covered(const Vec2& p, const Vec2& along, double cell, double length, double width) {
  int inside = 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      const Vec2 q = p + 0.2 * cell * Vec2(i, j);
      const double s = q.dot(along), t = q.dot(Vec2(-along.y(), along.x()));
      inside += s >= 0 && s <= length && std::abs(t) <= 0.5 * width ? 1 : 0;
    }
  return inside / 25.0;
}

/// One cell's share of the sums of a slice across the line.
struct Slice {
  double floor_sum = 0, floor_count = 0, moment = 0, removed = 0;
};

TrenchMeasure measure(const heightfield::Ground& ground, const scene::Dig& dig) {
  TrenchMeasure out;
  const Vec2 along = (dig.to - dig.from).normalized(), across(-along.y(), along.x());
  const double length = (dig.to - dig.from).norm(), cell = ground.cell(), area = cell * cell;
  std::vector<Slice> slices(static_cast<std::size_t>(std::floor(length / cell)));
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double drop = ground.start_height(ix, iy) - ground.height(ix, iy);
      const Vec2 p = ground.origin() + cell * Vec2(ix + 0.5, iy + 0.5) - dig.from;
      const double s = p.dot(along), t = p.dot(across);
      // Half a metre around the design belongs to the dig; wheel ruts lie farther off.
      if (s < -0.5 || s > length + 0.5 || std::abs(t) > 0.5 * dig.width + 0.5) continue;
      const double inside = covered(p, along, cell, length, dig.width);
      out.inside_volume += area * inside * std::clamp(drop, 0.0, dig.depth);
      out.overdug += area * (inside * std::max(drop - dig.depth, 0.0) + (1 - inside) * std::max(drop, 0.0));
      if (s < 0 || s >= cell * static_cast<double>(slices.size())) continue;
      Slice& slice = slices[static_cast<std::size_t>(s / cell)];
      if (drop > 0.5 * cell) slice.moment += drop * t, slice.removed += drop;
      // The floor is judged over the middle half of the width, clear of crumbs at the walls.
      if (std::abs(t) < 0.25 * dig.width) slice.floor_sum += drop, slice.floor_count += 1;
    }
  out.design_volume = length * dig.width * dig.depth;
  int good = 0;
  for (const Slice& slice : slices) {
    if (!(slice.floor_count > 0)) continue;
    const double depth = slice.floor_sum / slice.floor_count;
    if (std::abs(depth - dig.depth) <= 0.10) ++good;
    // Ends are ramps; the line is judged where at least half the depth was taken.
    if (depth > 0.5 * dig.depth)
      out.center_offset = std::max(out.center_offset, std::abs(slice.moment / slice.removed));
  }
  out.floor_share = good / static_cast<double>(slices.size());
  return out;
}

TEST(Trench, IsDugToItsDesignAndTheSpoilSwells) {
  scene_io::Overrides overrides;
  overrides.render = false;
  const scene::World description = scene_io::load_world(NAVVY_SOURCE_DIR "/scenarios/trench.sdf", overrides);
  const scene::Dig dig = dig_step(description);
  device::Device device;
  sim::Session session(description, device);
  double fastest_rise = 0;
  while (!session.done()) {
    session.step();
    fastest_rise = std::max(fastest_rise, std::abs(session.world().link(0, 0).v_WL.z()));
  }
  const heightfield::Ground& ground = session.world().ground();
  const TrenchMeasure trench = measure(ground, dig);
  const record::Earthwork earth = record::measure_earthwork(ground);
  const char* source = "issue 2, The trench";
  expect_between("design length [m]", (dig.to - dig.from).norm(), 3.0, 20, source);
  expect_between("design depth [m]", dig.depth, 0.8, 5, source);
  expect_between("centre line offset [m]", trench.center_offset, 0, 0.15, source);
  expect_between("floor within 0.10 m, share of length", trench.floor_share, 0.8, 1.0, source);
  expect_between("design volume removed, share", trench.inside_volume / trench.design_volume, 0.85, 1.0, source);
  expect_between("over-dug, share of design volume", trench.overdug / trench.design_volume, 0, 0.10, source);
  expect_between("bank volume [m3]", earth.bank_volume, 2.0, 20, source);
  expect_between("cycles", static_cast<double>(session.cycles().size()), 3, 60, source);
  expect_between("loose / bank / swell", earth.loose_volume / earth.bank_volume / description.soils[0].swell, 0.95,
                 1.05, source);
  expect_between("ledger error [units]", static_cast<double>(session.world().soil().ledger().error()), 0, 0, source);
  expect_between("shell crossings", static_cast<double>(session.world().soil().stats().shell_crossings), 0, 0, source);
  expect_between("momentum residual / scale", session.force().residual_max, 0, 1e-5, source);
  expect_between("machine's vertical speed [m/s]", fastest_rise, 0, 1.0, "issue 2, point 8");
  double worst_loss = 0;
  for (const sim::Cycle& cycle : session.cycles())
    if (cycle.payload_lift_out > 50)
      worst_loss = std::max(worst_loss, std::abs(cycle.payload_dump / cycle.payload_lift_out - 1));
  expect_between("payload change, lift-out to dump", worst_loss, 0, 0.01, "issue 2, Shell");
}

}  // namespace
}  // namespace navvy::validation
