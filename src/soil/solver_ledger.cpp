// SPDX-License-Identifier: Apache-2.0
// Queries of a solver: particles, payload, ledger, hash, snapshot.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <utility>

#include "core/archive.h"
#include "core/error.h"
#include "soil/solver.h"
#include "soil/solver_state.h"

namespace navvy::soil {

void Solver::State::check_masses() {
  // The device counts each transfer; a difference shows a lost or doubled particle at once.
  const std::vector<std::int64_t> counted = mass_count.take();
  for (std::size_t soil = 0; soil < counted.size(); ++soil) {
    if (counted[soil] == masses.in_particles()[soil]) continue;
    throw SimulationError(here() + "the particles of '" + world.soils[soil].name + "' weigh " +
                          std::to_string(counted[soil] - masses.in_particles()[soil]) +
                          " units of 2^-24 kg more than recorded");
  }
}

Ledger Solver::ledger() const { return state_->masses.ledger(state_->particles.masses()); }

std::vector<Particle> Solver::particles() const {
  std::vector<Particle> out = state_->particles.records();
  // Present positions, not those at the start of the transfer.
  for (Particle& p : out) {
    for (int a = 0; a < 3; ++a) p.x[a] += std::exchange(p.moved[a], 0.0f);
    p = in_cell_block(p);
  }
  // By id, so that the order does not depend on where particles are stored.
  std::sort(out.begin(), out.end(),
            [](const Particle& a, const Particle& b) { return a.id < b.id; });
  return out;
}

double Solver::payload(int tool, const Pose& X_WT, std::span<const PlacedTool> except) const {
  HeldSpace& space = state_->held_space(tool);
  const Pose X_TW = X_WT.inverse();
  // Bounding box of what it can hold, in the grid [cells]. Wider than rounding.
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& corner : state_->contact.geometry(tool).hull_points()) {
    const Vec3 grid = (X_WT * corner - state_->frame.origin) / state_->frame.cell;
    low = low.cwiseMin(grid);
    high = high.cwiseMax(grid);
  }
  constexpr double kWider = 1e-3;
  low.array() -= kWider;
  high.array() += kWider;
  std::vector<std::pair<HeldSpace*, Pose>> others;
  for (const PlacedTool& other : except)
    others.emplace_back(&state_->held_space(other.tool), other.X_WT.inverse());
  std::int64_t sum = 0;
  for (const PointMass& p : state_->particles.masses_near(low, high)) {
    const Vec3 p_W = state_->frame.origin + p.grid * state_->frame.cell;
    // Soil in the `except` tools is theirs.
    const auto holds = [&](const auto& other) { return other.first->holds(other.second * p_W); };
    if (space.holds(X_TW * p_W) && std::none_of(others.begin(), others.end(), holds)) sum += p.mass;
  }
  return kilograms(sum);
}

void Solver::places(std::vector<ParticlePlace>& out) const { state_->particles.places(out); }

std::function<bool(const Vec3&)> Solver::holding(std::span<const PlacedTool> tools) const {
  struct Space {
    HeldSpace* held;
    Pose X_TW;
    Vec3 low, high;  // box in W
  };
  std::vector<Space> spaces;
  for (const PlacedTool& tool : tools) {
    Space space{&state_->held_space(tool.tool), tool.X_WT.inverse(), Vec3::Constant(1e300),
                Vec3::Constant(-1e300)};
    for (const Vec3& corner : state_->contact.geometry(tool.tool).hull_points()) {
      space.low = space.low.cwiseMin(tool.X_WT * corner);
      space.high = space.high.cwiseMax(tool.X_WT * corner);
    }
    spaces.push_back(space);
  }
  return [spaces = std::move(spaces)](const Vec3& p_W) {
    for (const Space& space : spaces) {
      // Most points are far from any tool.
      if ((p_W.array() < space.low.array()).any() || (p_W.array() > space.high.array()).any())
        continue;
      if (space.held->holds(space.X_TW * p_W)) return true;
    }
    return false;
  };
}

const Vec3& Solver::grid_origin() const { return state_->frame.origin; }
const PlanGrid& Solver::grid() const { return state_->frame.grid; }
const SolverStats& Solver::stats() const { return state_->stats; }

std::vector<std::pair<std::string, double>> Solver::stage_times() const {
  return {state_->times.begin(), state_->times.end()};
}

static void visit(Archive& a, SolverStats& stats) {
  a("steps", stats.steps);
  a("particle_steps", stats.particle_steps);
  a("particles", stats.particles);
  a("particles_peak", stats.particles_peak);
  a("blocks", stats.blocks);
  a("rebins", stats.rebins);
  a("activations", stats.activations);
  a("deposits", stats.deposits);
  a("shell_crossings", stats.shell_crossings);
  a("max_speed", stats.max_speed);
}

// The order of the parts is the order of their fields in hashes and snapshots.
void Solver::State::visit(Archive& a) {
  a("particles", particles);
  a("time", time);
  a.require(std::isfinite(time) && time >= 0, "time", "must be finite and not negative");
  a("exchange_clock", exchange_clock);
  a("masses", masses);
  a.unhashed("counts for people, no step reads them", [&] { a("stats", stats); });
  a("contact", contact);
  a("exchange", exchange);
  a("standing", standing);
  a("transfer", current);
}

// Lists and layout follow from the blocks, and from the poses for which the lists were made.
void Solver::State::rebuild(Archive& a) {
  ParticleStore& store = particles.store();
  // Sums that are not saved because particles and ground determine them.
  masses.set_particles(store.masses(world.soils.size()));
  floor = Floor(ground, frame.grid, scheme.held_margin);
  contact.list_near(store.table());
  transfer.set_blocks(store, contact.near_slot(), store.set_near(contact.near_particle_blocks()));
  floor.update(store.table().active, true);
  transfer.set_floor(floor.blocks());
  ground_changed = true;
  current.restore(a);
}

void Solver::visit(Archive& a) {
  // An energy account is not part of the state: it begins anew after loading.
  a.section("soil", 6, [&] {
    state_->visit(a);
    if (a.loading()) state_->rebuild(a);
    if (a.loading() && state_->energy) state_->open_energy();
  });
}

}  // namespace navvy::soil
