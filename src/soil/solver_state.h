// SPDX-License-Identifier: Apache-2.0
// What a Solver holds; shared by the sources of the solver only.
#pragma once

#include <chrono>
#include <map>
#include <optional>

#include "device/device.h"
#include "soil/energy_ledger.h"
#include "soil/exchange/exchange.h"
#include "soil/particles/floor.h"
#include "soil/particles/interval.h"
#include "soil/particles/mass_count.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/soil_table.h"
#include "soil/particles/transfer.h"
#include "soil/solver.h"
#include "soil/tools/contact.h"
#include "soil/tools/resting_contact.h"

namespace navvy::soil {

struct Solver::State {
  State(device::Device& device_in, const scene::Scene& world_in, heightfield::Ground& ground_in);

  void advance_in_parts(double dt, int parts, std::span<const ToolMotion> motions,
                        std::span<ToolImpulse> impulses);
  void advance(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses);
  void exchange_if_due(double dt, double tool_speed, std::span<const ToolMotion> motions);
  void check_exchange(double elapsed, double dt, std::span<const ToolMotion> motions);
  /// Tools that stand take seats; `all`: every particle.
  void settle_tools(double elapsed, std::span<const ToolMotion> motions,
                    std::span<const ToolRegion> regions, std::span<const Particle> all);
  /// Of the ground under a tool: columns, and what lies on them.
  Vec3 normal_of_ground(const scene::Shell& shell, const ToolMotion& motion,
                        const ToolRegion& region, std::span<const Particle> all) const;
  /// Of the plane that fits it best in a rectangle of the plan.
  Vec2 gradient_of_ground(const Vec2& from, const Vec2& to, std::span<const Particle> all) const;
  /// Ground that wakes under a tool no longer bears it.
  void release_contacts(std::span<const ToolRegion> regions, std::span<const Particle> born);
  /// What seats give.
  void apply_resting_contacts(double dt, std::span<const ToolMotion> motions,
                              std::span<ToolImpulse> impulses);
  Vec3 place_of(const Particle& p) const;  ///< in W [m]
  void rebin_if_due();
  void lay_out(std::span<const ToolMotion> motions);
  void update_floor();
  /// Whether this step belongs to the transfer that is under way.
  bool holds(double dt, double tool_speed, std::span<const ToolMotion> motions) const;
  /// Queues a step's kernels; `hold`: not the first step of a transfer.
  void queue(double dt, bool hold);
  /// Particles go where the transfer that is under way takes them; then blocks, lists and sides may
  /// change.
  void end_transfer();
  void open_energy();
  void add(std::vector<Particle> particles);
  void assign(const std::vector<Particle>& particles);
  /// What there is, on the device or because the device had no room on the host.
  std::vector<Particle> records() const { return unplaced.empty() ? store.records() : unplaced; }
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  void record_left_site(const std::vector<Particle>& left);
  double tool_speed(const ToolMotion& motion) const;
  Ledger ledger() const;
  /// With these masses of particles instead of a count on the device.
  Ledger ledger_with(std::vector<std::int64_t> particles) const;
  void check_masses();
  /// Throws when no step can carry this motion.
  void check_motion(const ToolMotion& motion) const;
  /// "soil step 12, t = 0.02 s: ", the start of every fault.
  std::string here() const;
  [[noreturn]] void fail(double speed) const;
  void visit(Archive& a);
  void visit_particles(Archive& a);
  void visit_nodes(Archive& a);
  /// What follows from the state, after it was loaded.
  void rebuild(Archive& a);

  device::Device& device;
  scene::Scene world;
  heightfield::Ground& ground;
  double cell;
  PlanGrid grid;
  Vec3 origin;  ///< W of the grid frame's origin
  double fastest_sound;
  double transfer_length;  ///< [s]
  ParticleStore store;
  Transfer transfer;
  Contact contact;
  Floor floor;
  Exchange exchange;
  MassCount mass_count;

  std::vector<RestingContact> resting_contacts;  ///< by tool
  std::span<const SupportArea> support_areas;    ///< of the step under way
  /// All particles, once the device could not take them: the run is over.
  std::vector<Particle> unplaced;
  /// The transfer under way; the next step ends it where it cannot go on.
  TransferInterval interval;
  std::vector<float> loaded_nodes[2];  ///< while loading: node velocities of the transfer under way
  bool blocks_changed = true;
  std::optional<EnergyLedger> energy;  ///< only when asked for
  bool crowding = true;                ///< particles are moved apart where they crowd
  bool over_budget = false;            ///< said so already
  double drift = 0;                    ///< cells particles may have moved since the last re-bin
  double time = 0;         ///< simulated, sum over steps; only handed to the exchange [s]
  double since_check = 0;  ///< [s]
  double travel = 0;       ///< of the fastest tool since the last check [m]
  std::uint32_t steps_since_check = 0;
  bool first_check = true;
  std::uint32_t next_id = 1;
  std::vector<std::int64_t> left_site, inserted;
  std::vector<std::int64_t> in_particles;  ///< what every step must count again, per soil
  SolverStats stats;
  std::map<std::string, double> times;
};

/// Adds the wall time of its life to a stage.
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

/// The same particle with its block the one its cell lies in.
Particle in_cell_block(Particle p);

}  // namespace navvy::soil
