// SPDX-License-Identifier: Apache-2.0
// A session: a world with its operators and samplers, which can be stepped, saved and hashed as a
// unit.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/planners.h"
#include "core/archive.h"
#include "session/collision.h"
#include "session/forbidden_watch.h"
#include "session/overlap_watch.h"
#include "session/reports.h"
#include "session/travel.h"
#include "sim/world.h"

namespace navvy::heightfield {
class Ground;
struct DesignSurface;
}  // namespace navvy::heightfield

namespace navvy::session {

/// Runs a world together with the operators that carry out the programs of its scene.
///
/// If a machine has a program, its operator controls the machine until one of the machine's inputs
/// is set through this class. From then on only inputs control the machine, and its program does
/// not continue. Machines without a program are controlled by inputs from the start.
///
/// The cost of a step is that of the world's step. Operators add some microseconds, plus one pass
/// over the particles in steps in which they need the ground surface. Not thread-safe.
class Session {
 public:
  /// Builds the world of a scene and checks its programs. `planners` makes path planners for steps
  /// that plan paths; usually it is planner::path_planners(). `make_engine` makes the physics
  /// engine of the world, as for sim::World; if it is empty, the default engine is used. @throws
  /// InputError with all targets that are out of reach and all machines that overlap or start in
  /// the ground; device::DeviceError if the OpenCL device fails.
  Session(scene::Scene description, device::Device& device, const control::Planners& planners = {},
          const vehicle::PhysicsEngineFactory& make_engine = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Advances the session by one base step: operators command their machines, the world takes its
  /// step, and samplers that are due take a sample. @throws SimulationError with step, time and
  /// cause.
  void step();
  /// Returns true if the run is over. This is the case if the scene's duration has elapsed, or if
  /// every program has ended (successfully or not), the settling time has passed since, and no
  /// loose soil is active; active soil delays the end by six settling times at most. A program that
  /// inputs have taken over, or that was ordered, never counts as ended, and without programs only
  /// the duration ends the run. A forbidden event ends the run at once.
  bool done() const;
  /// Returns true if every program is done or has been taken over by inputs, and no machine has
  /// fallen, left the site or been pushed away without a program.
  bool complete() const;
  /// Returns true if a step of a program has failed, or if a machine has fallen (tipped over or
  /// been buried), left the site or been pushed away while no program controlled it.
  bool fell_short() const;
  /// Returns the first event that the scene forbids (scene::Forbidden) and that has occurred; empty
  /// if there was none. It ends the run as failed.
  const std::optional<ForbiddenEvent>& forbidden() const;

  /// Returns the world for reading. To command machines, use the functions of this class.
  const sim::World& world() const;
  /// Sets the input with the index `input`. As with all commands below, the first command to a
  /// machine with a program takes over the machine: the program ends, the machine stops, and then
  /// the command takes effect. @throws InputError for an invalid input or value; the program
  /// continues in that case.
  void set(int input, double value);
  /// Sets the input with the name `input`, like the function above.
  void set(const std::string& input, double value);
  /// Commands a joint. Takes over the machine and throws as `set` does.
  void command(const sim::JointHandle& joint, const vehicle::JointInput& input);
  /// Commands the drive of a machine. Takes over the machine and throws as `set` does.
  void command(const sim::MachineHandle& machine, const vehicle::DriveInput& input);
  /// Applies or releases the brake of a joint. Takes over the machine and throws as `set` does.
  void brake(const sim::JointHandle& joint, bool on);
  /// Commands the target pose of a kinematic machine. Takes over the machine and throws as `set`
  /// does.
  void command(const sim::MachineHandle& machine, const vehicle::BaseInput& input);
  /// Gives a machine a new program in place of the one that it has, if any. It begins with the next
  /// step, whoever drove the machine before; afterwards the run ends no longer because all programs
  /// have ended. `steps` contains the elements of the steps, as inside <navvy:program>. With `now`,
  /// a program that still runs is stopped; without, it refuses the order.
  /// @throws InputError if no program can be ordered here (control::Planners::read_program), for a
  /// machine that does not exist or is busy, and for steps that are faulty or out of reach; nothing
  /// changes then.
  void order(const std::string& machine, const std::string& steps, bool now = false);
  /// Changes the ground columns before the first step (sim::World::reshape). @throws Error as that
  /// function does.
  void reshape(const std::function<void(heightfield::Ground&)>& change);
  /// Adds a sampler, such as a sensor. It takes its first sample immediately and then samples at
  /// its own rate. @throws InputError as sim::World::add does.
  void add(std::unique_ptr<sim::Sampler> sampler);

  /// Returns the name of the OpenCL device, as reported by its driver.
  const std::string& device_name() const;
  /// Returns the design surface that programs work to (scene::Scene::commanded_design), resampled
  /// to the columns of the site; null if there is none.
  const heightfield::DesignSurface* design() const;
  /// Returns what the machine with the index `machine` is doing: the phase of its operator (see
  /// control::Operator::phase), "idle" if it has no program, "inputs" after inputs have taken over,
  /// or "tipped", "buried", "off_site" or "moved" if that has happened without a program.
  std::string phase(int machine) const;
  /// Returns the reports of all programs, in the order of the machines. A program still running
  /// when the scene's duration has elapsed is out of time. A machine that has fallen without a
  /// program has a report with 0 steps. The cost is one pass over the particles if the measurements
  /// of a running step need the surface.
  std::vector<ProgramReport> programs() const;
  /// Returns all completed digging cycles, in the order in which they ended.
  const std::vector<Cycle>& cycles() const;
  /// Returns the collisions of machines so far, with their number.
  const CollisionWatch& collisions() const;
  /// Returns the overlaps of bodies so far that lasted, with their number.
  const OverlapWatch& overlaps() const;
  /// Returns the distances that machines have driven.
  const TravelLog& travel() const;
  /// Returns all completed bed tips, in the order in which they ended.
  const std::vector<BedTip>& tips() const;
  /// Returns the force statistics over all steps so far.
  const ForceStatistics& force() const;
  /// Adds pose and velocities of the link named `link` to the outputs (see sim::World::watch).
  /// Snapshots do not contain this setting.
  void watch(const std::string& link);
  /// Enables the energy balance of the soil, for the world and for each digging cycle. This does
  /// not change any result, but makes the soil computation up to three times slower. Snapshots do
  /// not contain this setting.
  void keep_soil_energy();
  /// Returns the energy balance of the soil at the end of each cycle, in the order of `cycles`.
  /// Entries of cycles that ended before `keep_soil_energy` was called are empty.
  const std::vector<std::optional<sim::SoilEnergy>>& energy_at_ends() const;
  /// Returns the work that the drives and cylinders of all machines have done so far [J].
  double energy() const;
  /// Returns the wall time that operators have taken so far [s].
  double control_time() const;

  /// Saves or loads the world, the operators and their results (see core/saved_state.h). Loading
  /// requires a session with the same scene and the same samplers. If it throws, the session can
  /// only be loaded again or destroyed.
  void visit(Archive& a);
  /// Returns a hash [hex] of all state that determines the future of the run. The cost is one pass
  /// over the state.
  std::string state_hash() const;
  /// Returns name and hash [hex] of each part of the state: the parts of sim::World::hash_parts,
  /// followed by "operators".
  std::vector<std::pair<std::string, std::string>> hash_parts() const;
  /// Writes a snapshot to the file `path`, which is replaced as a whole. @throws FileError if
  /// writing fails.
  void save(const std::string& path) const;
  /// Loads the snapshot in the file `path`, which must belong to the same scene. If `anyway` is
  /// true, parameters of the scene may differ; the differences are logged. @throws FileError if
  /// reading fails; InputError that names a damaged or differing part, after which the session can
  /// only be loaded again or destroyed.
  void load(const std::string& path, bool anyway = false);
  /// Returns the bytes that `save` writes to a file.
  std::vector<char> snapshot() const;
  /// Loads the bytes of a snapshot; checks and @throws as `load` does, without the name of a file.
  void restore(const std::vector<char>& bytes, bool anyway = false);

 private:
  /// Returns true if the scene's duration has elapsed.
  bool time_is_over() const;

  struct State;
  // World, operators and results.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::session
