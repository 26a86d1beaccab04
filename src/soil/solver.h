// SPDX-License-Identifier: Apache-2.0
// Particle soil: MLS-MPM on OpenCL where soil moves, columns where it rests.
#pragma once

#include <cstdint>
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

/// Mass ledger in kMassQuantum per soil, counted from the arrays when it is asked for.
struct Ledger {
  /// Change of the ground since the start.
  std::vector<std::int64_t> columns;
  /// Sum of particle masses. A particle with a NaN is not counted, so it shows as lost.
  std::vector<std::int64_t> particles;
  /// Mass that left the site.
  std::vector<std::int64_t> left_site;
  /// Mass that came in through `insert`.
  std::vector<std::int64_t> inserted;
  /// Returns the sum over soils of |columns + particles + left_site - inserted|; 0 = closed.
  std::int64_t error() const;
};

/// Counters of a run, for progress and telemetry. No step reads them.
struct SolverStats {
  /// Steps since the start.
  std::uint64_t steps = 0;
  /// Sum of the number of particles over all steps.
  std::uint64_t particle_steps = 0;
  /// Number of particles, now and at most.
  int particles = 0, particles_peak = 0;
  /// Number of blocks that hold particles.
  int blocks = 0;
  /// Re-bins, activated columns, deposited blocks.
  std::uint64_t rebins = 0, activations = 0, deposits = 0;
  /// Particles found on the wrong side of a shell, summed over steps.
  std::uint64_t shell_crossings = 0;
  /// Fastest particle in the last step [m/s].
  double max_speed = 0;
};

/// Soil of one world.
///
/// Owns the particles and changes the Ground it was given: activation turns columns into particles,
/// deposition turns particles into columns. `step` blocks until the impulses are on the host.
/// Results are bit-repeatable on one device and driver.
class Solver {
 public:
  /// Builds the kernels for this scene.
  /// @throws InputError for soils that the law cannot compute.
  /// @throws device::DeviceError with the build log.
  Solver(device::Device& device, const scene::Scene& world, heightfield::Ground& ground,
         const SchemeConstants& scheme = kScheme);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Registers a shell and returns its tool index.
  int add_tool(const scene::Shell& shell);

  /// Switches the separation of crowded particles, which is on unless a rig measures its effect.
  /// Not part of the state.
  void set_crowding(bool on);

  /// Opens or closes an energy account. It changes no bit of the soil, but costs more than the
  /// steps themselves. It is not part of the state: after loading it starts anew with the next
  /// transfer.
  void record_energy(bool on);
  /// Returns the account since it was opened, or null without one.
  const EnergyAccount* energy() const;

  /// Returns the largest stable step when the fastest tool moves at `tool_speed` [m/s] [s].
  double step_limit(double tool_speed) const;

  /// Advances the soil by dt [s]. `impulses` has one entry per motion. Active soil that lies under
  /// `footings`, or will before the next check of the exchange, is deposited into the columns,
  /// which then carry the load [docs/exchange.md, support areas].
  /// @throws SimulationError with step and cause when a value is not finite or the ledger opens.
  void step(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses,
            std::span<const SupportArea> support_areas = {});

  /// Turns every column of the rectangle above `z_bottom` [m in W] into particles (for tests, rigs
  /// and first pictures).
  void activate(const heightfield::CellRect& rect, double z_bottom);
  /// Adds free particles (for tests and rigs). The ledger records their mass as new.
  void insert(const std::vector<Particle>& particles);

  /// Fills a shell from its lowest point up with `mass` [kg] of loose soil at rest. The ledger
  /// records it as new.
  /// @throws InputError when the shell holds less.
  void fill(int tool, const Pose& X_WT, int soil, double mass);

  /// Returns a host copy of all particles, ordered by id.
  std::vector<Particle> particles() const;
  /// Returns the origin of the particles' grid frame G in W [m].
  const Vec3& grid_origin() const;
  /// Returns the position of blocks among the columns.
  const PlanGrid& grid() const;
  /// Returns the payload of a tool: mass [kg] of the particles inside its convex hull, extended to
  /// the mouth, without those that tools of `except` hold. A dump bed does not carry the soil in a
  /// bucket that reaches into it.
  double payload(int tool, const Pose& X_WT, std::span<const PlacedTool> except = {}) const;

  /// Returns 1 for each of `particles` (positions in W) that one of the tools holds, by the rule of
  /// `payload`, else 0.
  std::vector<std::uint8_t> held(std::span<const Particle> particles,
                                 std::span<const PlacedTool> tools) const;

  /// Counts the masses of all particles and columns; waits for the device.
  Ledger ledger() const;
  /// Returns the counters.
  const SolverStats& stats() const;
  /// Returns seconds of wall time by stage name ("particles", "exchange", ...).
  std::vector<std::pair<std::string, double>> stage_times() const;

  /// Visits particles, clocks, ledger and the memory of the exchange. The ground is visited before,
  /// and the same tools are registered before loading.
  /// @throws InputError for a state of another scene, or a damaged one.
  void visit(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::soil
