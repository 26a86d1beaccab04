// SPDX-License-Identifier: Apache-2.0
// State of a Solver, shared by the sources of the solver only.
#pragma once

#include <chrono>
#include <map>
#include <optional>

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

namespace navvy::soil {

/// The parts of a solver and the order in which a step calls them. Every part visits its own state.
///
/// A step runs in this order. Everything in parentheses happens once per transfer, before its first
/// step:
///
/// - (end the previous transfer: particles move, forces of tools are averaged)
/// - (check the exchange if it is due: columns become particles, particles become columns)
/// - (re-bin if particles drifted far, update near lists and floors, classify sides)
/// - law and scatter, node velocities, contact with tools, gather
/// - (count masses on the device)
/// - read the report, sum impulses, apply resting contacts
///
/// The host waits for the device once per step, when it reads the report.
struct Solver::State {
  State(device::Device& device, const scene::Scene& world_in, heightfield::Ground& ground_in,
        const SchemeConstants& scheme_in);

  /// Splits a step of dt [s] into equal parts, between which the tools move and yield.
  void advance_in_parts(double dt, int parts, std::span<const ToolMotion> motions,
                        std::span<ToolImpulse> impulses);
  /// Advances by one step of dt [s], which the stability limit allows.
  void advance(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses);
  /// Runs the kernels of a step and reads what they give; `hold`: not the first step of a transfer.
  void step_particles(double dt, double tool_speed, bool hold, std::span<const ToolMotion> motions,
                      std::span<ToolImpulse> impulses);
  /// Queues the kernels of a step.
  void queue(double dt, bool hold);

  /// Checks the exchange between two transfers, if its clock says so.
  void exchange_if_due(double dt, double tool_speed, std::span<const ToolMotion> motions);
  /// Runs one check of the exchange and applies its result.
  void check_exchange(double dt, std::span<const ToolMotion> motions);
  /// Removes flagged particles (all stay without flags) and adds the new ones with ids.
  void replace(const std::vector<Particle>& all, const std::vector<std::uint8_t>& removed,
               std::vector<Particle> born);
  /// Ends the current transfer: particles move, and lists may change.
  void end_transfer() { particles.add_drift(current.end()); }
  /// Sorts particles that drifted far into new blocks.
  void rebin_if_due();
  /// Updates near lists, tiles and floors for the tools' poses.
  void update_lists(std::span<const ToolMotion> motions);
  /// Uploads the heights of resting ground where they changed.
  void update_floor();
  /// Adds particles, with new ids.
  void add(std::vector<Particle> added);
  /// Replaces all particles on the device and their masses in the ledger.
  void assign(const std::vector<Particle>& all);
  /// Starts a new energy account.
  void open_energy();

  /// Returns the speed of the fastest vertex of a tool [m/s].
  double tool_speed(const ToolMotion& motion) const;
  /// Returns the bounding box of a tool in W, and the velocity of its centre.
  ToolRegion region_of(const ToolMotion& motion) const;
  /// Compares the masses counted on the device with the ledger.
  /// @throws SimulationError naming the soil when they differ.
  void check_masses();
  /// @throws SimulationError when no step can carry this motion.
  void check_motion(const ToolMotion& motion) const;
  /// Returns "soil step 12, t = 0.02 s: ", the start of every fault.
  std::string here() const;
  /// Throws the fault of a particle that is too fast or not finite, with its id and position.
  [[noreturn]] void fail(double speed) const;

  /// Visits all parts, in the order of the format.
  void visit(Archive& a);
  /// Makes what follows from the state, after it was loaded.
  void rebuild(Archive& a);

  // Constants of the scene.
  scene::Scene world;
  heightfield::Ground& ground;
  SchemeConstants scheme;
  GridFrame frame;
  /// Speed of the fastest compression wave of all soils [m/s].
  double fastest_sound;

  // On the device.
  SoilParticles particles;
  Transfer transfer;
  Contact contact;
  CurrentTransfer current;
  MassCount mass_count;

  // On the host.
  Floor floor;
  Exchange exchange;
  ExchangeClock exchange_clock;
  StandingTools standing;
  MassRecord masses;
  /// Only on request.
  std::optional<EnergyLedger> energy;
  /// Crowded particles are separated.
  bool crowding = true;

  /// Simulated time, the sum over steps [s].
  double time = 0;
  /// Support areas of the current step.
  std::span<const SupportArea> support_areas;
  SolverStats stats;
  /// Wall time by stage [s].
  std::map<std::string, double> times;
};

/// Adds the wall time of its own lifetime to a stage.
class StageClock {
 public:
  StageClock(std::map<std::string, double>& times, const char* stage)
      : seconds_(times[stage]), start_(std::chrono::steady_clock::now()) {}
  ~StageClock() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace navvy::soil
