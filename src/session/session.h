// SPDX-License-Identifier: Apache-2.0
// A world with its operators and samplers as one thing that steps, ends, saves and hashes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/path_planner.h"
#include "core/archive.h"
#include "session/reports.h"
#include "sim/world.h"

namespace navvy::heightfield {
struct DesignSurface;
}

namespace navvy::session {

/// A world and the operators that carry out the programs of its scene.
///
/// An operator drives each machine that has a program, until an input of the machine is set through
/// this class. From then on inputs alone drive it, for good. Machines without a program are driven
/// by inputs from the start. The cost of a step is that of the world's step; operators add some
/// microseconds, and a view of the ground where a step of a program needs one. Not thread-safe.
class Session {
 public:
  /// Builds the world of a scene and checks its programs. `planners` makes path planners for steps
  /// that need paths, usually planner::path_planners(). `make_engine` makes the world's physics
  /// engine, as for sim::World.
  /// @throws InputError that lists all targets out of reach and all machines that overlap or start
  /// in the ground; device::DeviceError for the device.
  Session(scene::Scene description, device::Device& device,
          const control::MakePathPlanner& planners = {},
          const vehicle::PhysicsEngineFactory& make_engine = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Advances by one base step: operators command their machines, the world steps, and samplers
  /// that are due take a sample. @throws SimulationError with step, time and cause.
  void step();
  /// Returns true if every program has ended, done or not, and the settling time has passed, or if
  /// the scene's duration is over. A machine that inputs drive keeps the run from ending by
  /// programs.
  bool done() const;
  /// Returns true if every program is done or was taken by inputs, and no machine fell over.
  bool complete() const;
  /// Returns true if a step of a program failed, which ends the program, or if a machine fell over
  /// while no program drove it.
  bool fell_short() const;

  /// Returns the world, for reading. Commands go through this session.
  const sim::World& world() const;
  /// Sets inputs and commands as World's functions of the same names do. The first of them that
  /// reaches a machine with a program takes the machine from it: its joints stop, its drive brakes,
  /// then the value holds. @throws InputError as World's functions do; the program then goes on.
  void set(int input, double value);
  void set(const std::string& input, double value);
  void command(const sim::JointHandle& joint, const vehicle::JointInput& input);
  void command(const sim::MachineHandle& machine, const vehicle::DriveInput& input);
  void brake(const sim::JointHandle& joint, bool on);
  void command(const sim::MachineHandle& machine, const vehicle::BaseInput& input);
  /// Adds a sampler, such as a sensor. It takes a sample at once and then at its rate.
  /// @throws InputError as World::add does.
  void add(std::unique_ptr<sim::Sampler> sampler);

  /// Returns the name of the OpenCL device, as its driver gives it.
  const std::string& device_name() const;
  /// Returns the scene's design surface on the columns of the site; null if the scene has none.
  const heightfield::DesignSurface* design() const;
  /// Returns the activity of a machine: the phase of its operator (control::Operator::phase),
  /// "idle" without a program, "inputs" once inputs took it, "tipped" or "buried" after a fall.
  std::string phase(int machine) const;
  /// Returns how the programs stand, in the order of the machines. A program that still runs at the
  /// end of the duration is out of time. A machine that fell over without a program has a report
  /// with no steps. Costs a view of the ground if a step's report needs one.
  std::vector<ProgramReport> programs() const;
  /// Returns the completed digging cycles, in the order in which they ended.
  const std::vector<Cycle>& cycles() const;
  /// Returns the completed bed tips, in the order in which they ended.
  const std::vector<BedTip>& tips() const;
  /// Returns force statistics over all steps so far.
  const ForceStatistics& force() const;
  /// Adds pose and velocities of a link to the outputs (World::watch). Not part of the state.
  void watch(const std::string& link);
  /// Opens the account of the soil's energy, for the world and for each cycle. It changes no result
  /// and makes the soil up to three times as slow. Not part of the state.
  void keep_soil_energy();
  /// Returns the soil's energy account at the end of each of cycles(); empty for cycles that ended
  /// before the account was opened.
  const std::vector<std::optional<sim::SoilEnergy>>& energy_at_ends() const;
  /// Returns the work of the drives and cylinders of all machines [J].
  double energy() const;
  /// Returns the wall time that operators took [s].
  double control_time() const;

  /// Visits the world, the operators and their results (core/saved_state.h). Loads only into a
  /// session of the same scene with the same samplers. After an exception the session can only be
  /// loaded again or destroyed.
  void visit(Archive& a);
  /// Returns the hash of everything that determines the future of the run [hex]. Costs a pass over
  /// the state.
  std::string state_hash() const;
  /// Returns name and hash [hex] of each part of the state: those of World::hash_parts, then
  /// "operators".
  std::vector<std::pair<std::string, std::string>> hash_parts() const;
  /// Writes a snapshot, atomically. @throws FileError.
  void save(const std::string& path) const;
  /// Loads a snapshot of the same scene. With `anyway` the scene's parameters may differ; the log
  /// lists the differences. @throws FileError; InputError that names the damaged or differing part,
  /// after which the session can only be loaded again or destroyed.
  void load(const std::string& path, bool anyway = false);

 private:
  bool time_is_over() const;

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::session
