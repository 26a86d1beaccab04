// SPDX-License-Identifier: Apache-2.0
// What a solver tells about itself: particles, payload, ledger, hash, snapshot.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

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
  Ledger out = ledger_with(store.masses(world.soils.size()));
  if (!unplaced.empty()) {
    out.particles.assign(world.soils.size(), 0);
    for (const Particle& p : unplaced) out.particles[p.soil] += p.mass;
  }
  return out;
}

void Solver::State::check_masses() {
  const std::vector<std::int64_t> counted = mass_count.take();
  for (std::size_t soil = 0; soil < counted.size(); ++soil) {
    if (counted[soil] == in_particles[soil]) continue;
    throw SimulationError(here() + "the particles of '" + world.soils[soil].name + "' weigh " +
                          std::to_string(counted[soil] - in_particles[soil]) + " units of 2^-24 kg more than booked");
  }
}

Ledger Solver::ledger() const { return state_->ledger(); }

std::vector<Particle> Solver::particles() const {
  std::vector<Particle> out = state_->records();
  for (Particle& p : out) p = in_cell_block(p);
  std::sort(out.begin(), out.end(), [](const Particle& a, const Particle& b) { return a.id < b.id; });
  return out;
}

std::vector<PointMass> Solver::State::masses_near(const Vec3& low, const Vec3& high) const {
  if (unplaced.empty()) return store.masses_near(low, high);
  std::vector<PointMass> out;
  for (const Particle& p : unplaced) {
    PointMass point;
    for (int a = 0; a < 3; ++a) point.grid[a] = kBlockCells * p.block[a] + static_cast<double>(p.x[a]);
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
    if (geometry.holds(X_TW * p_W, closest) && std::none_of(others.begin(), others.end(), holds)) sum += p.mass;
  }
  return kilograms(sum);
}

const Vec3& Solver::grid_origin() const { return state_->origin; }
const PlanGrid& Solver::grid() const { return state_->grid; }
const SolverStats& Solver::stats() const { return state_->stats; }

std::vector<std::pair<std::string, double>> Solver::stage_times() const {
  return {state_->times.begin(), state_->times.end()};
}

void Solver::hash(StateHash& hash) const {
  const State& s = *state_;
  s.store.hash(hash);
  hash.value(s.drift);
  hash.value(s.travel);
  hash.value(s.since_check);
  hash.value(s.steps_since_check);
  hash.value(s.next_id);
  for (const std::int64_t m : s.left_site) hash.value(m);
  for (const std::int64_t m : s.inserted) hash.value(m);
  s.exchange.hash(hash);
}

void Solver::save(StateWriter& writer) const {
  const State& s = *state_;
  writer.begin("soil", 1);
  writer.vector(s.records());
  writer.value(s.blocks_changed);
  writer.value(s.drift);
  writer.value(s.time);
  writer.value(s.since_check);
  writer.value(s.travel);
  writer.value(s.steps_since_check);
  writer.value(s.first_check);
  writer.value(s.next_id);
  writer.vector(s.left_site);
  writer.vector(s.inserted);
  writer.value(s.stats);
  s.contact.save(writer);
  writer.end();
  s.exchange.save(writer);
}

void Solver::load(StateReader& reader) {
  State& s = *state_;
  reader.begin("soil", 1);
  s.store.assign(reader.vector<Particle>(), true);
  s.unplaced.clear();
  s.blocks_changed = reader.value<bool>();
  s.drift = reader.value<double>();
  s.time = reader.value<double>();
  s.since_check = reader.value<double>();
  s.travel = reader.value<double>();
  s.steps_since_check = reader.value<std::uint32_t>();
  s.first_check = reader.value<bool>();
  s.next_id = reader.value<std::uint32_t>();
  s.left_site = reader.vector<std::int64_t>();
  s.inserted = reader.vector<std::int64_t>();
  s.in_particles = s.store.masses(s.world.soils.size());
  s.stats = reader.value<SolverStats>();
  s.contact.load(reader);
  reader.end();
  s.exchange.load(reader);
  // Lists and layout follow from the blocks and the poses the lists were made for.
  s.floor = Floor(s.ground, s.grid);
  s.contact.list_near(s.store.table());
  s.transfer.set_blocks(s.store, s.contact.near_slot(), s.store.set_near(s.contact.near_homes()));
  s.floor.update(s.store.table().active, true);
  s.transfer.set_floor(s.floor.blocks());
}

}  // namespace navvy::soil
