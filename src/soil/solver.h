// SPDX-License-Identifier: Apache-2.0
// Solver of the soil: MLS-MPM particles on OpenCL where soil moves, columns where soil rests.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/machine.h"
#include "scene/scene.h"
#include "soil/energy.h"
#include "soil/exchange/support_area.h"
#include "soil/particles/particle.h"
#include "soil/particles/plan_grid.h"
#include "soil/scheme_constants.h"
#include "soil/tools/tool_motion.h"

namespace navvy {
class Archive;
}
namespace navvy::device {
class Device;
}

namespace navvy::soil {

/// Mass ledger: integer masses in kMassQuantum, one entry per soil in each vector. It is counted
/// from the columns and particles when it is requested.
struct Ledger {
  /// Change of the mass of the columns since the start.
  std::vector<std::int64_t> columns;
  /// Total mass of the particles. A particle with a value that is not finite is not counted, so its
  /// mass appears as missing.
  std::vector<std::int64_t> particles;
  /// Mass of the particles that left the site.
  std::vector<std::int64_t> left_site;
  /// Mass inserted from outside, by Solver::insert and Solver::fill.
  std::vector<std::int64_t> inserted;
  /// Returns the sum over all soils of |columns + particles - inserted + left_site|; 0 means that
  /// the ledger is balanced.
  std::int64_t error() const;
};

/// Counters of a run, for progress and telemetry. They have no effect on the simulation.
struct SolverStats {
  /// Number of steps since the start.
  std::uint64_t steps = 0;
  /// Number of particles, summed over all steps.
  std::uint64_t particle_steps = 0;
  /// Number of particles: `particles` after the last step, `particles_peak` the largest so far.
  int particles = 0, particles_peak = 0;
  /// Number of blocks that contain particles.
  int blocks = 0;
  /// Numbers of active blocks, whose nodes are computed, and of the nodes in those active blocks
  /// that a shell may touch.
  int active_blocks = 0, near_nodes = 0;
  /// Numbers of re-bins, of columns turned into particles, and of particle blocks deposited into
  /// columns, since the start.
  std::uint64_t rebins = 0, activations = 0, deposits = 0;
  /// Number of particles found on the wrong side of a shell, summed over all transfers.
  std::uint64_t shell_crossings = 0;
  /// Largest velocity component of any particle after the last step [m/s].
  double max_speed = 0;
};

/// Simulates the soil of one world.
///
/// The solver owns the particles and modifies the Ground that it was given: activation turns
/// columns into particles, deposition turns particles into columns. `step` blocks until the
/// impulses on the tools are on the host. Results are bit-repeatable on the same device and driver.
class Solver {
 public:
  /// Creates a solver without particles and builds its kernels. `device` and `ground` must outlive
  /// the solver; `world` is copied. `scheme`: constants of the particle scheme, which the kernels
  /// are built with.
  /// @throws InputError for soils that the soil law cannot compute.
  /// @throws device::DeviceError with the build log when a kernel does not compile.
  Solver(device::Device& device, const scene::Scene& world, heightfield::Ground& ground,
         const SchemeConstants& scheme = kScheme);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Registers a tool with this shell. Returns the tool's index: 0 for the first tool, then 1, 2,
  /// ...
  int add_tool(const scene::Shell& shell);

  /// Switches the separation of crowded particles on or off. It is on by default; rigs switch it
  /// off to measure its effect. The setting is not part of the saved state.
  void set_crowding(bool on);

  /// Starts a new energy account (true) or discards it (false). Recording does not change the soil
  /// by a single bit, but takes longer than the steps themselves. The account is not part of the
  /// saved state: after loading it restarts from zero with the next transfer.
  void record_energy(bool on);
  /// Returns the energies since recording began, or null when energy is not recorded.
  const EnergyAccount* energy() const;

  /// Returns the largest stable time step [s] when the fastest tool moves at `tool_speed` [m/s].
  double step_limit(double tool_speed) const;

  /// Advances the soil by dt [s]. A dt well above step_limit() is split into equal parts.
  ///
  /// `motions`: motion of each tool that takes part in the step. `impulses`: output, parallel to
  /// `motions`. `support_areas`: wheels and tracks on the ground. Active soil that is under a
  /// support area, or will be before the next check of the exchange, is deposited into the columns,
  /// which then carry the load [docs/exchange.md, support areas].
  /// @throws SimulationError with step and cause when a value is not finite or the mass ledger is
  /// not balanced.
  void step(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses,
            std::span<const SupportArea> support_areas = {});

  /// Turns the soil above `z_bottom` [m in W] of every column in `rect` into particles. For tests,
  /// rigs and scenes that start with active soil.
  void activate(const heightfield::CellRect& rect, double z_bottom);
  /// Adds particles that come from outside, with new IDs. The ledger records their mass as
  /// inserted. For tests and rigs.
  void insert(const std::vector<Particle>& particles);

  /// Fills a tool at pose `X_WT` from its lowest point upwards with `mass` [kg] of loose soil at
  /// rest. `soil`: index of the soil. The ledger records the mass as inserted.
  /// @throws InputError when the shell cannot hold that mass.
  void fill(int tool, const Pose& X_WT, int soil, double mass);

  /// Returns host copies of all particles at their current positions, ordered by ID.
  std::vector<Particle> particles() const;
  /// Replaces the contents of `out` by the current places of all particles. Their order depends on
  /// where the particles are stored, but not on the device or its threads.
  void places(std::vector<ParticlePlace>& out) const;
  /// Returns the origin in W [m] of the grid frame G, in which particle positions are given.
  const Vec3& grid_origin() const;
  /// Returns the offset of the particle blocks relative to the site's columns.
  const PlanGrid& grid() const;
  /// Returns the payload of a tool at pose `X_WT` [kg]: the mass of the particles in front of its
  /// plates and inside its convex hull, which is raised over the mouth by the height of a heap.
  ///
  /// Particles that a tool in `except` holds are not counted: the bed of a truck does not carry the
  /// soil in a bucket that reaches into the bed.
  double payload(int tool, const Pose& X_WT, std::span<const PlacedTool> except = {}) const;

  /// Returns a function that returns true for a point in W [m] if one of `tools` holds soil there,
  /// by the same rule as `payload`. It must not outlive the solver.
  std::function<bool(const Vec3&)> holding(std::span<const PlacedTool> tools) const;

  /// Counts the masses of all columns and particles; waits for the device.
  Ledger ledger() const;
  /// Returns the counters of the run.
  const SolverStats& stats() const;
  /// Returns the accumulated wall time of each stage of the step, as pairs of stage name
  /// ("particles", "exchange", ...) and time [s].
  std::vector<std::pair<std::string, double>> stage_times() const;

  /// Visits the complete state of the soil except the ground: particles, clocks, ledger, contacts
  /// and exchange. To load a state, load the ground first and register the same tools.
  /// @throws InputError for a state of another scene or a damaged state.
  void visit(Archive& a);

 private:
  /// Parts of the solver (solver_state.h).
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::soil
