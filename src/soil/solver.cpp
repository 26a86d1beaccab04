// SPDX-License-Identifier: Apache-2.0
#include "soil/solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "device/device_error.h"
#include "soil/particles/schedule.h"
#include "soil/solver_state.h"
#include "soil/time_step.h"

namespace navvy::soil {
namespace {

/// A step that exceeds the limit by this factor is not split: the limit has a Courant number of
/// 2/3, and contact and law are stable to 0.8 [docs/soil.md, time step]. Otherwise a base step
/// chosen for a slower tool would cost two half steps.
constexpr double kMostStep = 1.2;

/// A tool that is farther than this from all columns need not be followed closely by the exchange
/// [cells]: in the steps to the next check a tool of 3 m/s moves by little more than a cell of
/// 0.1 m, and the rules look a cell below a tool.
constexpr double kNearColumns = 4;

/// Returns the device, with its driver for few particles: a solver starts without any, and its
/// programs are then built for the driver that is used first.
device::Device& for_few(device::Device& device) {
  device.run_in_caller(true);
  return device;
}

/// Returns the motion after `t` seconds with `motion`'s twist, and with the new `twist` (angular,
/// linear) from then on.
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

/// Adds the impulses of a part of a step to those of the step.
void add_impulse(ToolImpulse& sum, const ToolImpulse& part) {
  // Moments are about each part's own origin; shift them to that of the first part.
  sum.L_W += part.L_W + (part.p_W - sum.p_W).cross(part.J_W);
  sum.J_W += part.J_W;
  sum.L_edge_W += part.L_edge_W + (part.p_W - sum.p_W).cross(part.J_edge_W);
  sum.J_edge_W += part.J_edge_W;
  sum.normal += part.normal;
  sum.friction += part.friction;
  sum.residual += part.residual;
  sum.residual_moment += part.residual_moment;
  sum.scale += part.scale;
  sum.scale_moment += part.scale_moment;
  // Means over a transfer: those of the last part are the newest.
  sum.force_W = part.force_W;
  sum.moment_W = part.moment_W;
  sum.edge_force_W = part.edge_force_W;
}

}  // namespace

Solver::State::State(device::Device& device_in, const scene::Scene& world_in,
                     heightfield::Ground& ground_in, const SchemeConstants& scheme_in)
    : device(for_few(device_in)),
      world(world_in),
      ground(ground_in),
      scheme(scheme_in),
      frame(world_in, ground_in),
      fastest_sound(soil::fastest_sound(world_in.soils)),
      particles(device,
                {-frame.grid.x, -frame.grid.y, ground_in.nx() - frame.grid.x,
                 ground_in.ny() - frame.grid.y},
                soil_table(world_in.soils, frame.cell, scheme_in), world_in.solver.max_particles),
      transfer(device, needs_extended_law(world_in.soils), scheme_in),
      contact(device, frame.cell, frame.origin, world_in.gravity, scheme_in),
      current(particles.store(), transfer, contact,
              scheme_in.transfer_length * frame.cell / fastest_sound,
              scheme_in.max_transfer_motion),
      mass_count(device, world_in.soils.size()),
      floor(ground_in, frame.grid, scheme_in.held_margin),
      exchange(world_in, ground_in, scheme_in),
      standing(world, ground_in, frame, contact),
      masses(ground_in, world_in.soils.size()),
      few_particles(soil::few_particles(device)) {}

Solver::Solver(device::Device& device, const scene::Scene& world, heightfield::Ground& ground,
               const SchemeConstants& scheme)
    : state_(std::make_unique<State>(device, world, ground, scheme)) {}
Solver::~Solver() = default;

int Solver::add_tool(const scene::Shell& shell) {
  state_->standing.add_tool();
  const int tool = state_->contact.add_tool(shell);
  state_->held_spaces.emplace_back(state_->contact.geometry(tool));
  return tool;
}

// The lab and tests switch the separation of crowded particles off to show its effect.
void Solver::set_crowding(bool on) { state_->crowding = on; }

void Solver::record_energy(bool on) {
  state_->energy.reset();
  if (on) state_->open_energy();
}

void Solver::State::open_energy() {
  energy.emplace(world.soils, frame.cell, world.gravity, scheme);
}

const EnergyAccount* Solver::energy() const {
  return state_->energy ? &state_->energy->account() : nullptr;
}

double Solver::step_limit(double tool_speed) const {
  return soil::step_limit(state_->world.solver, state_->frame.cell, state_->fastest_sound,
                          tool_speed);
}

// A rigid tool is fastest at one of its vertices.
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
  // A step well above the limit is split; the tools move and yield in between.
  // All parts are of equal length, so that no short last part wastes a step.
  const int parts =
      std::max(1, static_cast<int>(std::ceil(dt / (kMostStep * step_limit(fastest)))));
  for (std::size_t m = 0; m < motions.size(); ++m) {
    impulses[m] = ToolImpulse{};
    impulses[m].p_W = motions[m].X_WT.translation();
  }
  try {
    state_->advance_in_parts(dt, parts, motions, impulses);
  } catch (const device::DeviceError& error) {
    // The device does not know the time of the run; the message needs it.
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
      // A tool that yields changes its twist by its mobility times the impulse that it received.
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
  // Held: the step continues the current transfer with its nodes and lists.
  const bool hold = particles.count() > 0 && contact.moves_same(motions) &&
                    current.holds(dt, frame.cell, tools, world.gravity.norm());
  // Only between two transfers are positions current, which the exchange needs.
  if (!hold) {
    end_transfer();
    exchange_if_due(dt, tools, motions);
  }
  exchange_clock.advance(dt, tools);
  for (std::size_t m = 0; m < motions.size(); ++m) {
    impulses[m] = ToolImpulse{};
    impulses[m].p_W = motions[m].X_WT.translation();
  }
  if (hold) {
    // Nodes, lists and sides are those of the start of the transfer; only tools and ground move.
    contact.set_twists(motions);
    update_floor();
  } else if (particles.count() > 0) {
    choose_driver();
    rebin_if_due();
    update_lists(motions);
  }
  // The next check must look at once when a tool is released: there may be no particles to fall on.
  if (particles.count() > 0) {
    step_particles(dt, tools, hold, motions, impulses);
  } else {
    if (standing.apply(dt, motions, impulses)) exchange_clock.hurry();
    for (ToolImpulse& impulse : impulses) {
      // Without particles there is no transfer to average over, so the mean is that of the step.
      impulse.force_W = impulse.J_W / dt;
      impulse.moment_W = impulse.L_W / dt;
    }
  }
  time += dt;
  ++stats.steps;
  stats.particle_steps += static_cast<std::uint64_t>(particles.count());
  stats.particles = particles.count();
  stats.particles_peak = std::max(stats.particles_peak, stats.particles);
  stats.blocks = static_cast<int>(particles.store().particle_blocks().size());
  stats.active_blocks = static_cast<int>(particles.store().table().active.size());
  stats.near_nodes = contact.nodes().count * BLOCK_NODES;
}

void Solver::State::step_particles(double dt, double tool_speed, bool hold,
                                   std::span<const ToolMotion> motions,
                                   std::span<ToolImpulse> impulses) {
  ParticleStore& store = particles.store();
  // The ledger needs the particles before and after the step.
  if (energy) energy->begin_step(store, hold);
  queue(dt, hold);
  Transfer::Largest report;
  {
    StageClock clock(times, "particles");
    report = transfer.read_report(store.particle_blocks().size());
  }
  // Beyond this, particles would leave the nodes that their block reads. NaN fails, too.
  if (!(report.speed * dt / frame.cell < 1 - kMaxDrift / 4)) fail(report.speed);
  current.record_step(dt, frame.cell, report.speed, tool_speed);
  stats.max_speed = report.speed;
  // Sides are classified once per transfer.
  if (!hold) {
    particles.add_drift(report.push);
    stats.shell_crossings += report.crossed;
  }
  StageClock clock(times, "ledger");
  contact.sum_impulses(impulses);
  if (standing.apply(dt, motions, impulses)) exchange_clock.hurry();
  contact.add_impulses(dt, impulses);
  if (!hold) check_masses();
  if (energy) energy->end_step(store, transfer, contact, dt, hold, motions, impulses);
}

void Solver::State::queue(double dt, bool hold) {
  StageClock clock(times, "queue");
  ParticleStore& store = particles.store();
  contact.nodes().renew = std::exchange(ground_changed, false) || !hold;
  if (!hold) contact.classify(store, transfer);
  transfer.scatter(store, contact.nodes(), dt, frame.cell, world.gravity, hold);
  contact.solve(store, transfer, dt);
  transfer.gather(store, contact.nodes(), dt, crowding ? dt / current.length() : 0, frame.cell);
  contact.queue_read();
  // Nothing changes a mass while a transfer lasts.
  if (!hold) mass_count.queue(store);
}

void Solver::State::exchange_if_due(double dt, double tool_speed,
                                    std::span<const ToolMotion> motions) {
  if (!world.solver.exchange) return;
  // The next chance comes after the transfer that begins now.
  const double ahead = std::min(tool_speed * std::max(dt, current.length()),
                                scheme.max_transfer_motion * frame.cell);
  if (!exchange_clock.due(ahead, frame.cell)) return;
  if (exchange_clock.due_by_travel() && !near_columns(tool_speed, motions)) return;
  check_exchange(dt, motions);
  exchange_clock.restart();
}

bool Solver::State::near_columns(double tool_speed, std::span<const ToolMotion> motions) const {
  return std::any_of(motions.begin(), motions.end(), [&](const ToolMotion& motion) {
    // The travel is that of faster tools.
    if (this->tool_speed(motion) < 0.5 * tool_speed) return false;
    const ToolRegion region = region_of(motion);
    const double reach = kNearColumns * frame.cell;
    const Vec2 margin = Vec2::Constant(reach);
    const Vec2 low_W = region.min.head<2>() - margin, high_W = region.max.head<2>() + margin;
    const Vec2i low = ground.column_at(low_W.x(), low_W.y()),
                high = ground.column_at(high_W.x(), high_W.y());
    const heightfield::CellRect rect =
        heightfield::CellRect{low.x(), low.y(), high.x() + 1, high.y() + 1}.cut(ground.site_rect());
    return ground.highest(rect) > region.min.z() - reach;
  });
}

ToolRegion Solver::State::region_of(const ToolMotion& motion) const {
  ToolRegion region;
  bool first = true;
  for (const Vec3& v : contact.geometry(motion.tool).shell().vertices) {
    const Vec3 p = motion.X_WT * v;
    region.min = first ? p : region.min.cwiseMin(p);
    region.max = first ? p : region.max.cwiseMax(p);
    first = false;
  }
  // The velocity of the box is that of its middle, as the exchange knows no rotation.
  const Vec3 centre = 0.5 * (region.min + region.max) - motion.X_WT.translation();
  region.velocity = motion.v_WT + motion.w_WT.cross(centre);
  region.tool = motion.tool;
  return region;
}

void Solver::State::check_exchange(double dt, std::span<const ToolMotion> motions) {
  StageClock clock(times, "exchange");
  // The exchange sees tools as boxes in W with the velocity of their centre.
  std::vector<ToolRegion> regions;
  for (const ToolMotion& motion : motions) regions.push_back(region_of(motion));
  // Columns are judged by present positions, by the cell that holds them.
  const std::vector<Particle>& all = exchange_particles;
  particles.by_cell(exchange_particles);
  standing.update(exchange_clock.elapsed(), motions, regions, all);
  for (ToolRegion& region : regions) region.supported = standing.supports(region.tool);
  // The next check waits for the end of a transfer.
  const double until_next = (ExchangeClock::kSteps + 1) * dt + current.length();
  Exchange::Result result =
      exchange.check(all, regions, time, exchange_clock.elapsed(), {support_areas, until_next});
  stats.activations += static_cast<std::uint64_t>(result.activated_columns);
  stats.deposits += static_cast<std::uint64_t>(result.deposited_blocks);
  // Soil that became active under a tool carries it from now on.
  standing.release(regions, result.born);
  replace(all, std::move(result.removed), std::move(result.born));
  // Columns are counted anew. The device counts the particles in every transfer (check_masses).
  const std::int64_t error = masses.ledger(masses.in_particles()).error();
  if (error != 0) {
    throw SimulationError(here() + "the mass ledger is open by " + std::to_string(error) +
                          " units of 2^-24 kg");
  }
}

void Solver::State::replace(std::span<const Particle> all, std::vector<std::uint8_t> removed,
                            std::vector<Particle> born) {
  if (std::all_of(removed.begin(), removed.end(), [](std::uint8_t r) { return r == 0; }))
    removed.clear();
  if (removed.empty() && born.empty()) return;
  std::vector<std::int64_t> sums = masses.in_particles();
  for (std::size_t i = 0; i < removed.size(); ++i)
    if (removed[i] != 0) sums[all[i].soil] -= all[i].mass;
  for (Particle& p : born) {
    // Ids are never reused, so that a particle can be followed through snapshots.
    p.id = masses.new_id();
    sums[p.soil] += p.mass;
  }
  particles.change(removed, born);
  // Only now: without device memory they stay as they were.
  masses.set_particles(std::move(sums));
}

// Masses follow only once the store has the particles: without device memory they stay as they
// were.
void Solver::State::assign(const std::vector<Particle>& all) {
  particles.assign(all);
  masses.set_particles(all);
}

void Solver::State::add(std::vector<Particle> added) {
  if (added.empty()) return;
  end_transfer();
  std::vector<Particle> all = particles.store().records();
  for (Particle& p : added) {
    p.id = masses.new_id();
    all.push_back(p);
  }
  assign(all);
}

// Either driver gives bit-identical results.
void Solver::State::choose_driver() { device.run_in_caller(particles.count() < few_particles); }

void Solver::State::rebin_if_due() {
  if (!particles.rebin_due()) return;
  StageClock clock(times, "rebin");
  masses.record_left_site(particles.rebin());
  ++stats.rebins;
}

void Solver::State::update_lists(std::span<const ToolMotion> motions) {
  StageClock clock(times, "lists");
  ParticleStore& store = particles.store();
  // Lists remain valid until tools have moved by the contact margin, or blocks change.
  const bool lists = contact.set_motions(motions, store.table(), particles.blocks_changed());
  if (lists || particles.blocks_changed()) {
    const int tiles = store.set_near(contact.near_particle_blocks());
    transfer.set_blocks(store, contact.near_slot(), tiles);
    mass_count.reserve(store.particle_blocks().size());
  }
  update_floor();
  particles.clear_blocks_changed();
}

// Also in held steps: a loaded state knows only the ground of its own time.
void Solver::State::update_floor() {
  if (!floor.update(particles.store().table().active, particles.blocks_changed())) return;
  transfer.set_floor(floor.blocks());
  // Masses per free volume depend on the ground.
  ground_changed = true;
}

void Solver::activate(const heightfield::CellRect& rect, double z_bottom) {
  state_->end_transfer();
  state_->particles.by_cell(state_->exchange_particles);
  state_->add(state_->exchange.activate(rect, z_bottom, state_->exchange_particles));
}

void Solver::insert(const std::vector<Particle>& particles) {
  state_->masses.record_inserted(particles);
  state_->add(particles);
}

}  // namespace navvy::soil
