// SPDX-License-Identifier: Apache-2.0
// Tools that stand on the ground: who takes a seat, and what it gives [docs/tools.md, seat].
#include <algorithm>
#include <cmath>

#include "soil/exchange/exchange_index.h"
#include "soil/solver_state.h"

namespace navvy::soil {
namespace {

/// Soil of a seat's columns ends below the tool, or it would be within it when it wakes again
/// [cells over its lowest, along the ground's normal].
constexpr double kSoilOver = 0.5;

/// A tool's lower side is what is no higher than this over its lowest, along the normal [cells].
constexpr double kLowerSide = 1;

bool in_plan(const ToolRegion& region, const Vec3& p_W) {
  const auto at = p_W.head<2>().array();
  return (at >= region.min.head<2>().array()).all() && (at <= region.max.head<2>().array()).all();
}

}  // namespace

Vec3 Solver::State::place_of(const Particle& p) const {
  Vec3 out;
  for (int a = 0; a < 3; ++a)
    out[a] = static_cast<double>(kBlockCells) * p.block[a] + static_cast<double>(p.x[a]);
  return origin + cell * out;
}

Vec2 Solver::State::gradient_of_ground(const Vec2& from, const Vec2& to,
                                       std::span<const Particle> all) const {
  // Three columns each way at least: fewer have no plane.
  Vec2i low = ground.column_at(from.x(), from.y()), high = ground.column_at(to.x(), to.y());
  for (int a = 0; a < 2; ++a)
    if (high[a] - low[a] < 2) --low[a], ++high[a];
  const heightfield::CellRect rect =
      heightfield::CellRect{low.x(), low.y(), high.x() + 1, high.y() + 1}.cut(ground.site_rect());
  std::vector<Particle> near;
  for (const Particle& p : all) {
    const Vec3 at = place_of(p);
    const Vec2i column = ground.column_at(at.x(), at.y());
    if (rect.contains(column.x(), column.y())) near.push_back(p);
  }
  const ColumnIndex index(near, ground, grid);
  // The plane that fits best. On a lattice about its middle the two slopes are sums by themselves.
  const Vec2 middle(0.5 * (rect.x0 + rect.x1 - 1), 0.5 * (rect.y0 + rect.y1 - 1));
  Vec2 moment = Vec2::Zero(), square = Vec2::Zero();
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const Vec2 arm = Vec2(ix, iy) - middle;
      moment += (ground.height(ix, iy) / cell + index.pile_height(ix, iy)) * arm;
      square += arm.cwiseAbs2();
    }
  return {square.x() > 0 ? moment.x() / square.x() : 0,
          square.y() > 0 ? moment.y() / square.y() : 0};
}

Vec3 Solver::State::normal_of_ground(const scene::Shell& shell, const ToolMotion& motion,
                                     const ToolRegion& region,
                                     std::span<const Particle> all) const {
  const double across = (region.max - region.min).head<2>().maxCoeff();
  const Vec2 from = region.min.head<2>(), to = region.max.head<2>();
  const Vec3 first = normal_under(gradient_of_ground(from, to, all), across, cell);
  if (first == Vec3::UnitZ()) return first;
  // On a slope a tool hangs over ground that it does not stand on: once more under its lower side
  // alone.
  double lowest = HUGE_VAL;
  for (const Vec3& v : shell.vertices) lowest = std::min(lowest, first.dot(motion.X_WT * v));
  Vec2 low = to, high = from;
  for (const Vec3& v : shell.vertices) {
    const Vec3 p = motion.X_WT * v;
    if (first.dot(p) > lowest + kLowerSide * cell) continue;
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  return normal_under(gradient_of_ground(low, high, all), across, cell);
}

void Solver::State::settle_tools(double elapsed, std::span<const ToolMotion> motions,
                                 std::span<const ToolRegion> regions,
                                 std::span<const Particle> all) {
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const ToolMotion& motion = motions[m];
    RestingContact& seat = resting_contacts[static_cast<std::size_t>(motion.tool)];
    // A tool that does not yield needs nothing to stand on.
    if (motion.inverse_mass.isZero(0)) continue;
    const scene::Shell& shell = contact.geometry(motion.tool).shell();
    const Vec3 &force = contact.force(motion.tool), &moment = contact.moment(motion.tool);
    if (!seat.taken && !seat.stands(shell, motion, elapsed, force)) continue;
    const ToolRegion& region = regions[m];
    const Vec3 up = seat.taken ? seat.up : normal_of_ground(shell, motion, region, all);
    // The tool as seen along the normal: on level ground its box.
    const std::array<Vec3, 2> along = along_ground(up);
    const auto seen = [&](const Vec3& p) {
      return Vec3(along[0].dot(p), along[1].dot(p), up.dot(p));
    };
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    for (const Vec3& v : shell.vertices) {
      low = low.cwiseMin(seen(motion.X_WT * v));
      high = high.cwiseMax(seen(motion.X_WT * v));
    }
    const auto over = [&](const Particle& p) {
      const Vec3 at = seen(place_of(p));
      return at.z() > low.z() + kSoilOver * cell && at.x() >= low.x() && at.x() <= high.x() &&
             at.y() >= low.y() && at.y() <= high.y();
    };
    if (std::any_of(all.begin(), all.end(), over)) {
      seat.let_go();
      continue;
    }
    const Vec2i at = ground.column_at(motion.X_WT.translation().x(), motion.X_WT.translation().y());
    if (seat.taken || !ground.contains(at.x(), at.y())) continue;
    const double angle = world.soils[ground.surface_soil(at.x(), at.y())].tool_friction_angle;
    seat.take(shell, motion, force, moment, shell.friction_share * std::tan(angle), cell, up);
  }
}

void Solver::State::release_contacts(std::span<const ToolRegion> regions,
                                     std::span<const Particle> born) {
  for (const ToolRegion& region : regions)
    if (region.supported && std::any_of(born.begin(), born.end(), [&](const Particle& p) {
          return in_plan(region, place_of(p));
        }))
      resting_contacts[static_cast<std::size_t>(region.tool)].let_go();
}

void Solver::State::apply_resting_contacts(double dt, std::span<const ToolMotion> motions,
                                           std::span<ToolImpulse> impulses) {
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const scene::Shell& shell = contact.geometry(motions[m].tool).shell();
    // The next check must look at once: there may be no particles to fall on yet.
    if (resting_contacts[static_cast<std::size_t>(motions[m].tool)].hold(shell, motions[m], dt,
                                                                         cell, impulses[m]))
      first_check = true;
  }
}

}  // namespace navvy::soil
