// SPDX-License-Identifier: Apache-2.0
#include "soil/solver.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/log.h"
#include "device/device_error.h"
#include "soil/solver_state.h"

namespace navvy::soil {
namespace {

/// Drift that calls for a re-bin before the next transfer [cells]: one cell is the tile's margin,
/// less one push.
constexpr double kMostDrift = 0.75;
/// Tool travel between exchange checks [cells], and steps between them when no tool moves. Checks
/// wait for the end of a transfer.
constexpr double kCheckTravel = 0.3;
constexpr std::uint32_t kCheckSteps = 25;

/// A step this much over the limit is still taken in one: the limit has a Courant number of 0.5,
/// and contact and law hold to 0.8 [docs/soil.md, time step]; a caller with a base step made for a
/// slower tool is not punished by half steps.
constexpr double kMostStep = 1.3;

double fastest_sound_of(const std::vector<scene::Soil>& soils) {
  double out = 0;
  for (const scene::Soil& soil : soils) out = std::max(out, sound_speed(soil));
  return out;
}

ToolMotion moved(const ToolMotion& motion, const Vec6& twist, double t) {
  ToolMotion out = motion;
  out.w_WT = twist.head<3>();
  out.v_WT = twist.tail<3>();
  const double angle = motion.w_WT.norm() * t;
  if (angle > 0)
    out.X_WT.linear() = Eigen::AngleAxisd(angle, motion.w_WT.normalized()) * motion.X_WT.linear();
  out.X_WT.translation() += motion.v_WT * t;
  return out;
}

void add_impulse(ToolImpulse& sum, const ToolImpulse& part) {
  // Moments are about each part's own origin; bring them to the first one's.
  sum.L_W += part.L_W + (part.p_W - sum.p_W).cross(part.J_W);
  sum.J_W += part.J_W;
  sum.normal += part.normal;
  sum.friction += part.friction;
  sum.residual += part.residual;
  sum.residual_moment += part.residual_moment;
  sum.scale += part.scale;
  sum.scale_moment += part.scale_moment;
  // Means of a transfer: those of the last part are the newest.
  sum.force_W = part.force_W;
  sum.moment_W = part.moment_W;
}

}  // namespace

Particle in_cell_block(Particle p) {
  for (int a = 0; a < 3; ++a) {
    const int d = static_cast<int>(std::floor(p.x[a] / kBlockCells));
    p.block[a] += d;
    p.x[a] -= static_cast<float>(kBlockCells * d);
  }
  return p;
}

Solver::State::State(device::Device& device_in, const scene::Scene& world_in,
                     heightfield::Ground& ground_in)
    : device(device_in),
      world(world_in),
      ground(ground_in),
      cell(ground_in.cell()),
      grid(plan_grid(world_in, ground_in)),
      origin(ground_in.origin().x() + grid.x * cell, ground_in.origin().y() + grid.y * cell,
             ground_in.datum()),
      fastest_sound(fastest_sound_of(world_in.soils)),
      transfer_length(kTransferLength * cell / fastest_sound),
      store(device_in, {-grid.x, -grid.y, ground_in.nx() - grid.x, ground_in.ny() - grid.y},
            soil_table(world_in.soils, ground_in.cell())),
      transfer(device_in, needs_extended_law(world_in.soils)),
      contact(device_in, cell, origin, world_in.gravity),
      floor(ground_in, grid),
      exchange(world_in, ground_in),
      mass_count(device_in, world_in.soils.size()),
      left_site(world_in.soils.size(), 0),
      inserted(world_in.soils.size(), 0),
      in_particles(world_in.soils.size(), 0) {}

Solver::Solver(device::Device& device, const scene::Scene& world, heightfield::Ground& ground)
    : state_(std::make_unique<State>(device, world, ground)) {}
Solver::~Solver() = default;

int Solver::add_tool(const scene::Shell& shell) {
  state_->resting_contacts.emplace_back();
  return state_->contact.add_tool(shell);
}

void Solver::set_crowding(bool on) { state_->crowding = on; }

void Solver::record_energy(bool on) {
  state_->energy.reset();
  if (on) state_->open_energy();
}

void Solver::State::open_energy() { energy.emplace(world.soils, cell, world.gravity); }

const EnergyAccount* Solver::energy() const {
  return state_->energy ? &state_->energy->account() : nullptr;
}

double Solver::step_limit(double tool_speed) const {
  const scene::SolverSettings& settings = state_->world.solver;
  return std::min(settings.max_step,
                  settings.courant * state_->cell / (state_->fastest_sound + tool_speed));
}

double Solver::State::tool_speed(const ToolMotion& motion) const {
  double fastest = 0;
  for (const Vec3& v : contact.geometry(motion.tool).shell().vertices)
    fastest = std::max(fastest, (motion.v_WT + motion.w_WT.cross(motion.X_WT.linear() * v)).norm());
  return fastest;
}

void Solver::step(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses,
                  std::span<const SupportArea> support_areas) {
  state_->support_areas = support_areas;
  double fastest = 0;
  for (const ToolMotion& motion : motions) {
    state_->check_motion(motion);
    fastest = std::max(fastest, state_->tool_speed(motion));
  }
  // A step well beyond the limit is split; the tools move and yield in between.
  const int parts =
      std::max(1, static_cast<int>(std::ceil(dt / (kMostStep * step_limit(fastest)))));
  for (std::size_t m = 0; m < motions.size(); ++m) {
    impulses[m] = ToolImpulse{};
    impulses[m].p_W = motions[m].X_WT.translation();
  }
  try {
    state_->advance_in_parts(dt, parts, motions, impulses);
  } catch (const device::DeviceError& error) {
    throw device::DeviceError(state_->here() + error.what(), error.code());
  }
}

void Solver::State::advance_in_parts(double dt, int parts, std::span<const ToolMotion> motions,
                                     std::span<ToolImpulse> impulses) {
  const double part = dt / parts;
  std::vector<ToolMotion> now(motions.begin(), motions.end());
  std::vector<ToolImpulse> got(motions.size());
  for (int i = 0; i < parts; ++i) {
    advance(part, now, got);
    for (std::size_t m = 0; m < motions.size(); ++m) {
      add_impulse(impulses[m], got[m]);
      if (i + 1 == parts) continue;
      Vec6 twist, impulse;
      twist << now[m].w_WT, now[m].v_WT;
      impulse << got[m].L_W, got[m].J_W;
      now[m] = moved(now[m], twist + now[m].inverse_mass * impulse, part);
    }
  }
}

void Solver::State::advance(double dt, std::span<const ToolMotion> motions,
                            std::span<ToolImpulse> impulses) {
  double tools = 0;
  for (const ToolMotion& motion : motions) tools = std::max(tools, tool_speed(motion));
  const bool hold = holds(dt, tools, motions);
  if (!hold) {
    end_transfer();
    exchange_if_due(dt, tools, motions);
  }
  since_check += dt;
  travel += tools * dt;
  ++steps_since_check;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    impulses[m] = ToolImpulse{};
    impulses[m].p_W = motions[m].X_WT.translation();
  }
  if (hold) {
    contact.set_twists(motions);
    update_floor();
  } else if (store.count() > 0) {
    rebin_if_due();
    lay_out(motions);
  }
  if (store.count() > 0) {
    if (energy) energy->begin_step(store, hold);
    queue(dt, hold);
    Transfer::Largest report;
    {
      StageClock clock(times, "particles");
      report = transfer.read_report(store.particle_blocks().size());
    }
    if (!(report.speed * dt / cell < 1 - kMostDrift / 4)) fail(report.speed);
    interval.book(dt, cell, report.speed, tools);
    stats.max_speed = report.speed;
    if (!hold) {  // sides are looked at once a transfer
      drift += report.push;
      stats.shell_crossings += report.crossed;
    }
    StageClock clock(times, "books");
    contact.book(impulses);
    apply_resting_contacts(dt, motions, impulses);
    contact.feel(dt, impulses);
    if (!hold) check_masses();
    if (energy) energy->end_step(store, transfer, contact, dt, hold, motions, impulses);
  } else {
    apply_resting_contacts(dt, motions, impulses);
    for (ToolImpulse& impulse : impulses) {
      impulse.force_W = impulse.J_W / dt;
      impulse.moment_W = impulse.L_W / dt;
    }
  }
  time += dt;
  ++stats.steps;
  stats.particle_steps += static_cast<std::uint64_t>(store.count());
  stats.particles = store.count();
  stats.particles_peak = std::max(stats.particles_peak, stats.particles);
  stats.blocks = static_cast<int>(store.particle_blocks().size());
}

bool Solver::State::holds(double dt, double tool_speed, std::span<const ToolMotion> motions) const {
  return store.count() > 0 && contact.moves_same(motions) &&
         interval.holds(dt, transfer_length, cell, tool_speed, world.gravity.norm());
}

void Solver::State::queue(double dt, bool hold) {
  StageClock clock(times, "queue");
  if (!hold) contact.classify(store, transfer);
  transfer.scatter(store, contact.nodes(), dt, cell, world.gravity, hold);
  contact.solve(transfer, dt);
  transfer.gather(store, contact.nodes(), dt, crowding ? dt / transfer_length : 0, cell);
  contact.read_later();
  if (!hold) mass_count.queue(store);  // nothing changes a mass meanwhile
}

void Solver::State::end_transfer() {
  if (!interval.open) return;
  transfer.end(store);
  contact.end_transfer();
  drift += interval.motion;
  interval = {};
}

void Solver::State::exchange_if_due(double dt, double tool_speed,
                                    std::span<const ToolMotion> motions) {
  if (!world.solver.exchange) return;
  // The next chance comes after the transfer that begins now.
  const double ahead = std::min(tool_speed * std::max(dt, transfer_length), kMostHeld * cell);
  if (!first_check && steps_since_check < kCheckSteps && travel + ahead <= kCheckTravel * cell)
    return;
  check_exchange(since_check, dt, motions);
  first_check = false;
  since_check = travel = 0;
  steps_since_check = 0;
}

void Solver::State::check_exchange(double elapsed, double dt, std::span<const ToolMotion> motions) {
  StageClock clock(times, "exchange");
  std::vector<ToolRegion> regions;
  for (const ToolMotion& motion : motions) {
    ToolRegion region;
    bool first = true;
    for (const Vec3& v : contact.geometry(motion.tool).shell().vertices) {
      const Vec3 p = motion.X_WT * v;
      region.min = first ? p : region.min.cwiseMin(p);
      region.max = first ? p : region.max.cwiseMax(p);
      first = false;
    }
    const Vec3 centre = 0.5 * (region.min + region.max) - motion.X_WT.translation();
    region.velocity = motion.v_WT + motion.w_WT.cross(centre);
    region.tool = motion.tool;
    regions.push_back(region);
  }
  std::vector<Particle> all = store.records();
  for (Particle& p : all) p = in_cell_block(p);
  settle_tools(elapsed, motions, regions, all);
  for (ToolRegion& region : regions)
    region.supported = resting_contacts[static_cast<std::size_t>(region.tool)].taken;
  // The next check waits for the end of a transfer.
  const double until_next = (kCheckSteps + 1) * dt + transfer_length;
  Exchange::Result result =
      exchange.check(all, regions, time, elapsed, {support_areas, until_next});
  stats.wakes += static_cast<std::uint64_t>(result.activated_columns);
  stats.deposits += static_cast<std::uint64_t>(result.deposited_blocks);
  release_contacts(regions, result.born);
  const bool removed = std::any_of(result.removed.begin(), result.removed.end(),
                                   [](std::uint8_t r) { return r != 0; });
  if (removed || !result.born.empty()) {
    std::vector<Particle> stay;
    stay.reserve(all.size() + result.born.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!removed || result.removed[i] == 0) stay.push_back(all[i]);
    for (Particle& p : result.born) {
      p.id = next_id++;
      stay.push_back(p);
    }
    assign(stay);
  }
  // Columns counted anew; that the particles weigh what is booked the device counts in every step
  // (check_masses).
  const std::int64_t error = ledger_with(in_particles).error();
  if (error != 0) {
    throw SimulationError(here() + "the mass ledger is open by " + std::to_string(error) +
                          " units of 2^-24 kg");
  }
}

void Solver::State::assign(const std::vector<Particle>& particles) {
  const bool over = static_cast<int>(particles.size()) > world.solver.max_particles;
  if (over && !over_budget)
    log_warning("soil: " + std::to_string(particles.size()) +
                " particles are awake, more than the budget of " +
                std::to_string(world.solver.max_particles));
  over_budget = over;
  try {
    store.assign(particles);
  } catch (const device::DeviceError&) {
    unplaced = ParticleStore::sorted(particles);  // so that books and snapshot stay whole
    throw;
  }
  unplaced.clear();
  in_particles.assign(world.soils.size(), 0);
  for (const Particle& p : particles) in_particles[p.soil] += p.mass;
  blocks_changed = true;
  drift = 0;
}

void Solver::State::add(std::vector<Particle> particles) {
  if (particles.empty()) return;
  end_transfer();
  std::vector<Particle> all = store.records();
  for (Particle& p : particles) {
    p.id = next_id++;
    all.push_back(p);
  }
  assign(all);
}

void Solver::State::record_left_site(const std::vector<Particle>& left) {
  for (const Particle& p : left) {
    left_site[p.soil] += p.mass;
    in_particles[p.soil] -= p.mass;
  }
}

void Solver::State::rebin_if_due() {
  if (drift <= kMostDrift) return;
  StageClock clock(times, "rebin");
  record_left_site(store.rebin());
  ++stats.rebins;
  drift = 0;
  blocks_changed = true;
}

void Solver::State::lay_out(std::span<const ToolMotion> motions) {
  StageClock clock(times, "lists");
  const bool lists = contact.set_motions(motions, store.table(), blocks_changed);
  if (lists || blocks_changed) {
    const int tiles = store.set_near(contact.near_particle_blocks());
    transfer.set_blocks(store, contact.near_slot(), tiles);
    mass_count.reserve(store.particle_blocks().size());
  }
  update_floor();
  blocks_changed = false;
}

// In held steps, too: a state that was loaded knows only the ground of its moment.
void Solver::State::update_floor() {
  if (floor.update(store.table().active, blocks_changed)) transfer.set_floor(floor.blocks());
}

void Solver::wake(const heightfield::CellRect& rect, double z_bottom) {
  state_->end_transfer();
  std::vector<Particle> resting = state_->store.records();
  for (Particle& p : resting) p = in_cell_block(p);
  state_->add(state_->exchange.wake(rect, z_bottom, resting));
}

void Solver::insert(const std::vector<Particle>& particles) {
  for (const Particle& p : particles) state_->inserted.at(p.soil) += p.mass;
  state_->add(particles);
}

}  // namespace navvy::soil
