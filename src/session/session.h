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

/// A world and the operators that run the programs of its scene. A client of World like any other.
///
/// A machine with a program is driven by its operator until an input of it is set here; from then
/// on it is driven by inputs alone, for good. Machines without a program are driven by inputs from
/// the start. Not thread-safe.
class Session {
 public:
  /// `planners` is asked for paths by programs with a step that needs them, as a rule
  /// planner::path_planners().
  /// @throws InputError listing every target of a program that is out of reach and all machines
  /// that overlap, before anything moves; device::DeviceError for the device.
  Session(scene::Scene description, device::Device& device,
          const control::MakePathPlanner& planners = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Operators decide, then the world takes one base step and its samplers look. @throws
  /// SimulationError.
  void step();
  /// True when every program has ended, done or not, and the settling time has passed, or the
  /// scene's duration is over. A machine taken by inputs keeps the run from ending by its program.
  bool done() const;
  /// True when every program is done, or was taken by inputs, and no machine fell over: the run
  /// came to what its scene asked for.
  bool complete() const;
  /// True when a step of some program fell short of its aim, which ended that program, or a machine
  /// that no program drives fell over.
  bool fell_short() const;

  /// Read only: what drives it goes through this session.
  const sim::World& world() const;
  /// As World's functions of the same names. The first of them that reaches a machine with a
  /// program takes the machine from it: its joints stop, its drive brakes, then the value holds.
  /// @throws InputError as World's.
  void set(int input, double value);
  void set(const std::string& input, double value);
  void command(const sim::JointHandle& joint, const vehicle::JointInput& input);
  void command(const sim::MachineHandle& machine, const vehicle::DriveInput& input);
  void brake(const sim::JointHandle& joint, bool on);
  void command(const sim::MachineHandle& machine, const vehicle::BaseInput& input);
  /// Adds a sensor or a map; it looks at the world at once and then at its rate. @throws InputError
  /// as World::add.
  void add(std::unique_ptr<sim::Sampler> sampler);

  /// As the driver names it.
  const std::string& device_name() const;
  /// The scene's design on the columns of its site; null where it has none.
  const heightfield::DesignSurface* design() const;
  /// What the operator of this machine is at (control::Operator::phase); "idle" for a machine
  /// without a program, "inputs" once it was taken from it, "tipped" or "buried" when either fell.
  std::string phase(int machine) const;
  /// How the programs stand, in the order of the machines. A program that still runs when the
  /// duration is over is out of time. A machine that fell over without one has a report of no
  /// steps. Costs a look at the surface where a step's account asks for it.
  std::vector<ProgramReport> programs() const;
  /// Closed ones, in the order in which they ended.
  const std::vector<Cycle>& cycles() const;
  const std::vector<BedTip>& tips() const;
  const ForceStatistics& force() const;
  /// World::watch: a link's pose and velocities among the outputs. Not part of the state.
  void watch(const std::string& link);
  /// Keeps the soil's energy from now on: the world's, and that of each cycle. Not part of the
  /// state.
  void keep_soil_energy();
  /// The soil's account when each cycle ended, in the order of cycles(); none for cycles before it
  /// was opened.
  const std::vector<std::optional<sim::SoilEnergy>>& energy_at_ends() const;
  double energy() const;        ///< work of all machines' drives and cylinders [J]
  double control_time() const;  ///< wall time [s]

  /// The world, the operators and what they have come to, for core/saved_state.h. Loads into a
  /// session of the same scene with the same samplers only; whatever throws leaves it of no use but
  /// to be loaded again or destroyed.
  void visit(Archive& a);
  std::string state_hash() const;  ///< hex
  /// World::hash_parts, then the operators.
  std::vector<std::pair<std::string, std::string>> hash_parts() const;
  /// Snapshot to and from a file; atomic. @throws FileError, InputError.
  void save(const std::string& path) const;
  /// @param anyway a snapshot of a scene with other parameters is loaded too; what differs goes to
  /// the log
  void load(const std::string& path, bool anyway = false);

 private:
  bool time_is_over() const;

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::session
