// SPDX-License-Identifier: Apache-2.0
// Tools that stand on the ground: who takes a seat, and what it gives [docs/tools.md, seat].
#include <algorithm>
#include <cmath>

#include "soil/solver_state.h"

namespace navvy::soil {
namespace {

/// Soil of a seat's columns ends below the tool, or it would be within it when it wakes again [cells over its lowest].
constexpr double kSoilOver = 0.5;

bool in_plan(const ToolRegion& region, const Vec3& p_W) {
  const auto at = p_W.head<2>().array();
  return (at >= region.min.head<2>().array()).all() && (at <= region.max.head<2>().array()).all();
}

}  // namespace

Vec3 Solver::State::place_of(const Particle& p) const {
  Vec3 out;
  for (int a = 0; a < 3; ++a) out[a] = static_cast<double>(kBlockCells) * p.block[a] + static_cast<double>(p.x[a]);
  return origin + cell * out;
}

void Solver::State::settle_tools(double elapsed, std::span<const ToolMotion> motions,
                                 std::span<const ToolRegion> regions, std::span<const Particle> all) {
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const ToolMotion& motion = motions[m];
    Seat& seat = seats[static_cast<std::size_t>(motion.tool)];
    // A tool that does not yield needs nothing to stand on.
    if (motion.inverse_mass.isZero(0)) continue;
    const scene::Shell& shell = contact.geometry(motion.tool).shell();
    const Vec3 &force = contact.force(motion.tool), &moment = contact.moment(motion.tool);
    if (!seat.taken && !seat.stands(shell, motion, elapsed, force)) continue;
    const ToolRegion& region = regions[m];
    const double most = region.min.z() + kSoilOver * cell;
    const auto over = [&](const Particle& p) { return place_of(p).z() > most && in_plan(region, place_of(p)); };
    if (std::any_of(all.begin(), all.end(), over)) {
      seat.let_go();
      continue;
    }
    const Vec2i at = ground.column_at(motion.X_WT.translation().x(), motion.X_WT.translation().y());
    if (seat.taken || !ground.contains(at.x(), at.y())) continue;
    const double angle = world.soils[ground.surface_soil(at.x(), at.y())].tool_friction_angle;
    seat.take(shell, motion, force, moment, shell.friction_share * std::tan(angle), cell);
  }
}

void Solver::State::unseat(std::span<const ToolRegion> regions, std::span<const Particle> born) {
  for (const ToolRegion& region : regions)
    if (region.seated &&
        std::any_of(born.begin(), born.end(), [&](const Particle& p) { return in_plan(region, place_of(p)); }))
      seats[static_cast<std::size_t>(region.tool)].let_go();
}

void Solver::State::hold_tools(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses) {
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const scene::Shell& shell = contact.geometry(motions[m].tool).shell();
    // The next check must look at once: there may be no particles to fall on yet.
    if (seats[static_cast<std::size_t>(motions[m].tool)].hold(shell, motions[m], dt, cell, impulses[m]))
      first_check = true;
  }
}

}  // namespace navvy::soil
