// SPDX-License-Identifier: Apache-2.0
// What a solver tells about itself: particles, payload, ledger, hash, snapshot.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/archive.h"
#include "core/error.h"
#include "soil/solver.h"
#include "soil/solver_state.h"

namespace navvy::soil {
std::int64_t Ledger::error() const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < columns.size(); ++i)
    sum += std::abs(columns[i] + particles[i] + left_site[i] - inserted[i]);
  return sum;
}

Ledger Solver::State::ledger_with(std::vector<std::int64_t> particles) const {
  Ledger out;
  out.columns = ground.mass_change();
  out.columns.resize(world.soils.size(), 0);
  out.particles = std::move(particles);
  out.left_site = left_site;
  out.inserted = inserted;
  return out;
}

Ledger Solver::State::ledger() const {
  if (unplaced.empty()) return ledger_with(store.masses(world.soils.size()));
  std::vector<std::int64_t> particles(world.soils.size(), 0);
  for (const Particle& p : unplaced) particles[p.soil] += p.mass;
  return ledger_with(std::move(particles));
}

void Solver::State::check_masses() {
  const std::vector<std::int64_t> counted = mass_count.take();
  for (std::size_t soil = 0; soil < counted.size(); ++soil) {
    if (counted[soil] == in_particles[soil]) continue;
    throw SimulationError(here() + "the particles of '" + world.soils[soil].name + "' weigh " +
                          std::to_string(counted[soil] - in_particles[soil]) +
                          " units of 2^-24 kg more than booked");
  }
}

Ledger Solver::ledger() const { return state_->ledger(); }

std::vector<Particle> Solver::particles() const {
  std::vector<Particle> out = state_->records();
  // Where they are now, not where the transfer under way found them.
  for (Particle& p : out) {
    for (int a = 0; a < 3; ++a) p.x[a] += std::exchange(p.moved[a], 0.0f);
    p = in_cell_block(p);
  }
  std::sort(out.begin(), out.end(),
            [](const Particle& a, const Particle& b) { return a.id < b.id; });
  return out;
}

std::vector<PointMass> Solver::State::masses_near(const Vec3& low, const Vec3& high) const {
  if (unplaced.empty()) return store.masses_near(low, high);
  std::vector<PointMass> out;
  for (const Particle& p : unplaced) {
    PointMass point;
    for (int a = 0; a < 3; ++a)
      point.grid[a] =
          kBlockCells * p.block[a] + static_cast<double>(p.x[a]) + static_cast<double>(p.moved[a]);
    point.mass = p.mass;
    out.push_back(point);
  }
  return out;
}

double Solver::payload(int tool, const Pose& X_WT, std::span<const PlacedTool> except) const {
  const ShellGeometry& geometry = state_->contact.geometry(tool);
  const Pose X_TW = X_WT.inverse();
  Vec3 low = Vec3::Constant(1e300), high = -low;  // of what it can hold, in the grid [cells]
  for (const Vec3& corner : geometry.hull_points()) {
    const Vec3 grid = (X_WT * corner - state_->origin) / state_->cell;
    low = low.cwiseMin(grid);
    high = high.cwiseMax(grid);
  }
  std::vector<std::pair<const ShellGeometry*, Pose>> others;
  for (const PlacedTool& other : except)
    others.emplace_back(&state_->contact.geometry(other.tool), other.X_WT.inverse());
  std::int64_t sum = 0;
  int closest = 0;  // triangle of the particle before: neighbours in memory are neighbours in space
  for (const PointMass& p : state_->masses_near(low, high)) {
    const Vec3 p_W = state_->origin + p.grid * state_->cell;
    const auto holds = [&](const auto& other) { return other.first->holds(other.second * p_W); };
    if (geometry.holds(X_TW * p_W, closest) && std::none_of(others.begin(), others.end(), holds))
      sum += p.mass;
  }
  return kilograms(sum);
}

std::vector<std::uint8_t> Solver::held(std::span<const Particle> particles,
                                       std::span<const PlacedTool> tools) const {
  std::vector<std::uint8_t> out(particles.size(), 0);
  for (const PlacedTool& tool : tools) {
    const ShellGeometry& geometry = state_->contact.geometry(tool.tool);
    const Pose X_TW = tool.X_WT.inverse();
    // Most particles are far from any tool: a box in W answers for them.
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const Vec3& corner : geometry.hull_points()) {
      low = low.cwiseMin(tool.X_WT * corner);
      high = high.cwiseMax(tool.X_WT * corner);
    }
    int closest = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (out[i] != 0) continue;
      Vec3 grid;
      for (int a = 0; a < 3; ++a)
        grid[a] = kBlockCells * particles[i].block[a] + static_cast<double>(particles[i].x[a]);
      const Vec3 p_W = state_->origin + grid * state_->cell;
      if ((p_W.array() < low.array()).any() || (p_W.array() > high.array()).any()) continue;
      out[i] = geometry.holds(X_TW * p_W, closest) ? 1 : 0;
    }
  }
  return out;
}

const Vec3& Solver::grid_origin() const { return state_->origin; }
const PlanGrid& Solver::grid() const { return state_->grid; }
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
  a("wakes", stats.wakes);
  a("deposits", stats.deposits);
  a("shell_crossings", stats.shell_crossings);
  a("max_speed", stats.max_speed);
}

// What the device had no room for is saved like what lies on it.
void Solver::State::visit_particles(Archive& a) {
  if (!a.loading() && !unplaced.empty())
    ParticleStore::visit(a, unplaced, world.soils.size());
  else
    store.visit(a);
  if (a.loading()) unplaced.clear();
}

void Solver::State::visit(Archive& a) {
  visit_particles(a);
  // Decides whether the next step makes the near lists anew.
  a("blocks_changed", blocks_changed);
  a("drift", drift);
  a("time", time);
  a("since_check", since_check);
  a("travel", travel);
  for (const double value : {drift, time, since_check, travel})
    a.require(std::isfinite(value) && value >= 0, "clocks", "must be finite and not negative");
  a("steps_since_check", steps_since_check);
  a("first_check", first_check);
  a("next_id", next_id);
  a.fixed("left_site", left_site);
  a.fixed("inserted", inserted);
  a.unhashed("counts for people, no step reads them", [&] { a("stats", stats); });
  a("contact", contact);
  a("exchange", exchange);
  a.fixed("seats", resting_contacts);
  a("interval", interval);
  if (interval.open) visit_nodes(a);
}

// Velocities that the nodes keep while a transfer is under way, of every active block and of the
// near ones' backs: so a run with snapshots is the run without. Masses and what lies near shells
// follow from particles and poses.
void Solver::State::visit_nodes(Archive& a) {
  if (a.loading()) {
    a("front", loaded_nodes[0]);
    a("back", loaded_nodes[1]);
    return;
  }
  const auto front = transfer.velocity().map_read(0, store.table().active.size() * 4 * BLOCK_NODES);
  std::span<const float> felt = front.span();
  a("front", felt);
  const auto back = contact.nodes().velocity1.map_read(0, contact.nodes().values());
  std::span<const float> behind = back.span();
  a("back", behind);
}

// Lists and layout follow from the blocks and the poses the lists were made for.
void Solver::State::rebuild(Archive& a) {
  in_particles = store.masses(world.soils.size());
  floor = Floor(ground, grid);
  contact.list_near(store.table());
  transfer.set_blocks(store, contact.near_slot(), store.set_near(contact.near_particle_blocks()));
  floor.update(store.table().active, true);
  transfer.set_floor(floor.blocks());
  if (!interval.open) return;
  a.require(loaded_nodes[0].size() == store.table().active.size() * 4 * BLOCK_NODES &&
                loaded_nodes[1].size() == contact.nodes().values(),
            "front", "must be four numbers for each node of the blocks that the particles reach");
  transfer.velocity().write(loaded_nodes[0]);
  if (!loaded_nodes[1].empty()) contact.nodes().velocity1.write(loaded_nodes[1]);
  contact.go_on(transfer);
}

void Solver::visit(Archive& a) {
  a.section("soil", 5, [&] {
    state_->visit(a);
    if (a.loading()) state_->rebuild(a);
    if (a.loading() && state_->energy) state_->open_energy();
  });
}

}  // namespace navvy::soil
