// SPDX-License-Identifier: Apache-2.0
// The particle soil: MLS-MPM on OpenCL where soil moves, columns where it rests.
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
#include "soil/tools/tool_motion.h"

namespace navvy {
class Archive;
}
namespace navvy::device {
class Device;
}

namespace navvy::soil {

/// Counts of the ledger, in kMassQuantum per soil, recounted from the arrays at call time.
struct Ledger {
  std::vector<std::int64_t> columns;  ///< change of the ground against its start
  /// Sum of particle masses; a particle with a NaN counts as lost (not counted).
  std::vector<std::int64_t> particles;
  std::vector<std::int64_t> left_site;  ///< went over the edge
  std::vector<std::int64_t> inserted;   ///< came in through `insert`
  /// Sum over soils of |columns + particles + left_site - inserted|; 0 = closed.
  std::int64_t error() const;
};

struct SolverStats {
  std::uint64_t steps = 0;
  std::uint64_t particle_steps = 0;
  int particles = 0, particles_peak = 0;
  int blocks = 0;
  std::uint64_t rebins = 0, wakes = 0, deposits = 0;
  /// Particles found on the wrong side of a shell, summed over steps.
  std::uint64_t shell_crossings = 0;
  double max_speed = 0;  ///< fastest particle at the last re-bin check [m/s]
};

/// Soil of one world.
///
/// Owns the particles; changes the Ground it was given (wake takes columns up, deposit books them
/// back). `step` blocks until the impulses are on the host. Bit-repeatable on one device and
/// driver.
class Solver {
 public:
  /// @throws InputError for absurd soil, device::DeviceError with the build log.
  Solver(device::Device& device, const scene::Scene& world, heightfield::Ground& ground);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Registers a shell; returns its tool index.
  int add_tool(const scene::Shell& shell);

  /// Whether crowded particles are moved apart, as they are unless a rig asks what that changes;
  /// not part of the state.
  void set_crowding(bool on);

  /// Opens an account of energy, or closes it. It changes no bit of the soil, costs more than the
  /// steps themselves, and is not part of the state: with one that is loaded it begins anew, with
  /// the next transfer.
  void record_energy(bool on);
  /// Since it was opened; null when none is kept.
  const EnergyAccount* energy() const;

  /// Largest stable step at the given fastest speed of tools [s].
  double step_limit(double tool_speed) const;

  /// Advances soil by dt. `impulses` has one entry per motion. Awake soil that lies under
  /// `footings`, or will before the next check of the exchange, is booked into the columns, which
  /// bear them [docs/exchange.md, footings].
  /// @throws SimulationError with step and cause when a value is not finite or the ledger opens.
  void step(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses,
            std::span<const SupportArea> support_areas = {});

  /// Turns every column of the rectangle, from W height z_bottom up, into particles now (tests,
  /// rigs, first pictures).
  void wake(const heightfield::CellRect& rect, double z_bottom);
  /// Adds free particles (tests and rigs); their mass is booked as new in the ledger.
  void insert(const std::vector<Particle>& particles);

  /// Fills a shell from its lowest point up with `mass` [kg] of loose soil at rest; booked as new
  /// in the ledger.
  /// @throws InputError when it holds less.
  void fill(int tool, const Pose& X_WT, int soil, double mass);

  /// Host copy in a repeatable order (by id).
  std::vector<Particle> particles() const;
  /// W of the origin of the frame G that their blocks are counted in [m].
  const Vec3& grid_origin() const;
  /// Columns and blocks.
  const PlanGrid& grid() const;
  /// Mass [kg] of particles inside the tool's convex hull extended to its mouth, less what the
  /// tools of `except` hold there: the payload. A bed does not carry the soil in a bucket that
  /// reaches into it.
  double payload(int tool, const Pose& X_WT, std::span<const PlacedTool> except = {}) const;

  /// By particle of `particles`, in W, whether one of the tools holds it: 1 or 0, as `payload`
  /// would count it.
  std::vector<std::uint8_t> held(std::span<const Particle> particles,
                                 std::span<const PlacedTool> tools) const;

  Ledger ledger() const;
  const SolverStats& stats() const;
  /// Seconds of wall time by stage name ("p2g", "grid", "exchange", ...).
  std::vector<std::pair<std::string, double>> stage_times() const;

  /// Particles, clocks, books and what the exchange remembers. The ground is visited before it, and
  /// the same tools are registered before it is loaded. @throws InputError for a state of another
  /// scene, or a damaged one.
  void visit(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::soil
