// SPDX-License-Identifier: Apache-2.0
// Parts of a Solver. Only the source files of the solver include this header.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include "soil/current_transfer.h"
#include "soil/energy_ledger.h"
#include "soil/exchange/exchange.h"
#include "soil/exchange_clock.h"
#include "soil/grid_frame.h"
#include "soil/mass_record.h"
#include "soil/particles/floor.h"
#include "soil/particles/mass_count.h"
#include "soil/particles/soil_table.h"
#include "soil/particles/transfer.h"
#include "soil/soil_particles.h"
#include "soil/solver.h"
#include "soil/standing_tools.h"
#include "soil/tools/contact.h"
#include "soil/tools/held_space.h"

namespace navvy::soil {

/// The parts of a solver, and the functions that call them in the order of a step.
///
/// A step runs in the following order. Items in parentheses run once per transfer, before its first
/// step:
///
/// - (end the previous transfer: particles move, and tool forces are averaged)
/// - (check the exchange if it is due: columns become particles, particles become columns)
/// - (re-bin if particles have drifted far; update near lists and floors; classify particle sides)
/// - soil law and scatter, node velocities, contact with tools, gather
/// - (count the masses on the device)
/// - read the report, sum the impulses on tools, apply resting contacts
///
/// The host waits for the device once per step, when it reads the report.
struct Solver::State {
  /// Creates all parts for a scene. `device_in` and `ground_in` must outlive the state.
  State(device::Device& device_in, const scene::Scene& world_in, heightfield::Ground& ground_in,
        const SchemeConstants& scheme_in);

  /// Advances by dt [s] in `parts` equal steps. Between two of them each tool moves on, and a tool
  /// that is not scripted changes its velocity by the impulse it received. `impulses`: output,
  /// summed over the parts.
  void advance_in_parts(double dt, int parts, std::span<const ToolMotion> motions,
                        std::span<ToolImpulse> impulses);
  /// Advances by one step of dt [s], which must be within the stability limit. `impulses`: output,
  /// parallel to `motions`.
  void advance(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses);
  /// Runs the kernels of a step and reads their results. `tool_speed`: speed of the fastest tool
  /// [m/s]; `hold`: true for every step of a transfer except the first. Requires at least one
  /// particle.
  void step_particles(double dt, double tool_speed, bool hold, std::span<const ToolMotion> motions,
                      std::span<ToolImpulse> impulses);
  /// Queues the kernels of a step of dt [s] without waiting; `hold` as in step_particles.
  void queue(double dt, bool hold);

  /// Checks the exchange if its clock says that a check is due. Call it between two transfers only.
  /// `dt`: next step [s]; `tool_speed`: speed of the fastest tool [m/s].
  void exchange_if_due(double dt, double tool_speed, std::span<const ToolMotion> motions);
  /// Returns true if a tool that moves at least half as fast as the fastest one, of `tool_speed`
  /// [m/s], is near columns, or may be before the next check that is due by the number of steps.
  bool near_columns(double tool_speed, std::span<const ToolMotion> motions) const;
  /// Runs one check of the exchange and applies the result: updates resting contacts, adds and
  /// removes particles, and checks the ledger.
  /// @throws SimulationError when the mass ledger is not balanced.
  void check_exchange(double dt, std::span<const ToolMotion> motions);
  /// Removes the particles whose flag in `removed` is not 0 (none if `removed` is empty), and adds
  /// `born` with new IDs. `all`: all particles, in stored order, of which soil and mass are read.
  void replace(std::span<const Particle> all, std::vector<std::uint8_t> removed,
               std::vector<Particle> born);
  /// Selects the driver for the present number of particles: few of them are simulated in the
  /// caller's thread. Call it between two transfers only.
  void choose_driver();
  /// Ends the current transfer: particles move, and block lists may change until the next step.
  void end_transfer() { particles.add_drift(current.end()); }
  /// Sorts the particles into new blocks if their drift requires it; records the mass of those that
  /// left the site.
  void rebin_if_due();
  /// Updates the lists of blocks near tools, the tiles and the heights of resting ground for the
  /// tools' current poses.
  void update_lists(std::span<const ToolMotion> motions);
  /// Uploads the heights of the resting ground if the ground or the set of blocks has changed.
  void update_floor();
  /// Ends the transfer and adds particles with new IDs.
  void add(std::vector<Particle> added);
  /// Replaces all particles on the device, and their masses in the ledger.
  void assign(const std::vector<Particle>& all);
  /// Starts a new energy account.
  void open_energy();

  /// Returns the space in which tool `tool` holds soil.
  HeldSpace& held_space(int tool) { return held_spaces[static_cast<std::size_t>(tool)]; }
  /// Returns the speed of the fastest vertex of a tool [m/s].
  double tool_speed(const ToolMotion& motion) const;
  /// Returns the bounding box of a tool in W and the velocity of the box centre.
  ToolRegion region_of(const ToolMotion& motion) const;
  /// Compares the particle masses counted on the device with those in the ledger.
  /// @throws SimulationError naming the soil when they differ.
  void check_masses();
  /// Checks that a tool motion can be simulated.
  /// @throws SimulationError when a value of it is not finite, when the tool is faster than waves
  /// in the soil, or when it moves deep in the rock below the datum.
  void check_motion(const ToolMotion& motion) const;
  /// Returns the prefix of every error message of this solver, for example "soil step 12, t = 0.02
  /// s: ".
  std::string here() const;
  /// Throws the error for a particle that is too fast or not finite, with the particle's ID and
  /// position. `speed`: largest velocity component that the device reported [m/s].
  [[noreturn]] void fail(double speed) const;

  /// Visits all parts, in the order of the snapshot format.
  void visit(Archive& a);
  /// Recomputes everything that follows from the saved state, after the state was loaded.
  void rebuild(Archive& a);

  /// Device that runs the kernels.
  device::Device& device;
  /// Scene that is simulated; never changed.
  scene::Scene world;
  /// Columns of the site.
  heightfield::Ground& ground;
  /// Constants of the particle scheme; never changed.
  SchemeConstants scheme;
  /// Grid frame of the particles; never changed.
  GridFrame frame;
  /// Speed of the fastest compression wave in any soil of the scene [m/s]; limits the time step.
  double fastest_sound;

  /// Particles on the device.
  SoilParticles particles;
  /// Kernels between particles and nodes.
  Transfer transfer;
  /// Contact of tools with nodes and particles.
  Contact contact;
  /// Space in which each tool holds soil, by tool index.
  std::vector<HeldSpace> held_spaces;
  /// Progress of the current transfer.
  CurrentTransfer current;
  /// Count of the particle masses on the device.
  MassCount mass_count;

  /// Heights of resting ground below the nodes.
  Floor floor;
  /// Rules that turn columns into particles and back.
  Exchange exchange;
  /// Particles as the exchange sees them in a check, whose memory serves the next check, too.
  std::vector<Particle> exchange_particles;
  /// Clock of the checks of the exchange.
  ExchangeClock exchange_clock;
  /// Resting contacts of the tools.
  StandingTools standing;
  /// Masses that entered and left, and the next particle ID.
  MassRecord masses;
  /// Energy account; empty unless Solver::record_energy started one.
  std::optional<EnergyLedger> energy;
  /// Number of particles below which kernels run in the caller's thread.
  double few_particles;
  /// True if crowded particles are separated.
  bool crowding = true;
  /// True if the ground has changed since the last step, or a state was loaded: the next step then
  /// renews node data even in the middle of a transfer.
  bool ground_changed = true;

  /// Simulated time: the sum of all steps [s].
  double time = 0;
  /// Support areas of the current call of Solver::step; valid during that call only.
  std::span<const SupportArea> support_areas;
  /// Counters of the run.
  SolverStats stats;
  /// Accumulated wall time [s], keyed by stage name.
  std::map<std::string, double> times;
};

/// Measures the wall time from its construction to its destruction, and adds it to a stage's total.
class StageClock {
 public:
  /// Starts the clock for `stage`, a key of `times`, which must outlive this object.
  StageClock(std::map<std::string, double>& times, const char* stage)
      : seconds_(times[stage]), start_(std::chrono::steady_clock::now()) {}
  ~StageClock() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  /// Total of the stage [s].
  double& seconds_;
  /// Time of construction.
  std::chrono::steady_clock::time_point start_;
};

}  // namespace navvy::soil
