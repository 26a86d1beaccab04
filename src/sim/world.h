// SPDX-License-Identifier: Apache-2.0
// A running world: ground, soil and machines of a scene, stepped together.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.h"
#include "heightfield/layered_ground.h"
#include "scene/parameters.h"
#include "scene/scene.h"
#include "sim/array_outputs.h"
#include "sim/channels.h"
#include "sim/handles.h"
#include "sim/sampler.h"
#include "sim/world_measurements.h"
#include "vehicle/machine_state.h"

namespace navvy::device {
class Device;
}

namespace navvy::sim {

/// Ground, soil and machines of one scene with named inputs and outputs.
///
/// Knows no operator and writes no file: those are its clients (session, record, the `navvy`
/// program). One `step` is one base step of fixed length; the same scene, inputs, device and driver
/// give the same bits. Lengths and poses are in the world frame W, z up, in SI units. Not
/// thread-safe.
class World {
 public:
  /// Builds the ground from the scene (reads the heightmap file if it names one) and places the
  /// machines on it.
  /// @throws InputError for what cannot be built, device::DeviceError for the device.
  World(scene::Scene description, device::Device& device);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// A base may be put so far from the origin, along any axis [m].
  static constexpr double kFarthest = 1e6;

  /// The scene it was built from, with the order of machines, joints, soils that all indices
  /// follow.
  const scene::Scene& description() const;
  double dt() const;  ///< base step [s]; a loaded snapshot brings its own
  /// That soil and scene allow; a control rate makes the base step shorter [s].
  double longest_step() const;
  std::uint64_t steps() const;
  double time() const;  ///< steps x dt [s]

  /// Advances by one base step; then the samplers that fell due look at it. Blocks until the state
  /// is on the host.
  /// @throws SimulationError with step, time and cause; the state is then that of the fault.
  void step();

  // Named numbers. A look-up by name is for once; the index is as fast as a function call.
  /// Fixed for inputs; outputs grow by those of samplers.
  const std::vector<Channel>& inputs() const;
  const std::vector<Channel>& outputs() const;
  /// Index of a named channel. @throws InputError that names the nearest known one.
  int input(const std::string& name) const;
  int output(const std::string& name) const;
  /// In the channel's unit. @throws InputError for a value that is not finite, or an index that
  /// does not exist.
  void set(int input, double value);
  /// Now, in the channel's unit. Payloads cost a pass over the particles, the others nothing.
  double get(int output) const;
  void set(const std::string& name, double value) { set(input(name), value); }
  double get(const std::string& name) const { return get(output(name)); }

  /// From now on pose, velocity and angular velocity of a link, named "excavator/boom" for link
  /// boom of machine excavator, are among the outputs, after those there are:
  /// "excavator/boom/pose/x" to "/yaw", "/velocity/x", "/angular_velocity/x". A link that is
  /// watched already stays as it is.
  /// @throws InputError for a name without a machine or link; it names the nearest.
  void watch(const std::string& link);

  /// Named arrays: what samplers publish, with stamp, shape, unit and frame. Read in place.
  const ArrayOutputs& arrays() const;
  /// From now on `sampler` looks at this world, first at once. Its outputs come after those there
  /// are.
  /// @throws InputError for a name in use or a rate that makes no sense.
  void add(std::unique_ptr<Sampler> sampler);

  // Machines, in the order of description().machines.
  /// 0 for a scene of soil alone.
  int machine_count() const;
  /// @throws InputError that names the nearest machine, or says how many there are.
  MachineHandle machine(const std::string& name) const;
  MachineHandle machine(int index) const;
  /// Every shell of every machine, machine by machine.
  std::vector<ToolHandle> tools() const;
  /// Held until replaced. A joint that a drive also moves is the drive's again with the drive's
  /// next command.
  /// @throws InputError for a handle of no machine of this world, or a value that is not finite;
  /// nothing changes then.
  void command(const JointHandle& joint, const vehicle::JointInput& input);
  void command(const MachineHandle& machine, const vehicle::DriveInput& input);
  /// Puts a joint's brake on or off; what the joint is told meanwhile waits. @throws InputError for
  /// a joint without one.
  void brake(const JointHandle& joint, bool on);
  /// Opens a hitch of the scene, by its index there, or closes it. @throws InputError for one that
  /// does not exist, and for an eye that is out of the hook's reach.
  void couple(int hitch, bool closed);
  vehicle::HitchState hitch(int hitch) const;
  /// Of a kinematic machine: where its base goes. @throws InputError also for a machine that forces
  /// move.
  void command(const MachineHandle& machine, const vehicle::BaseInput& input);
  /// Only what `command` refuses. @throws InputError likewise.
  void require_valid(const JointHandle& joint, const vehicle::JointInput& input) const;
  void require_valid(const MachineHandle& machine, const vehicle::DriveInput& input) const;
  void require_valid(const MachineHandle& machine, const vehicle::BaseInput& input) const;
  void require_brake(const JointHandle& joint) const;

  /// The resting ground.
  const heightfield::Ground& ground() const;
  /// Copies; the ledger and the loose soil cost a pass over the particles.
  /// What world_measurements.h explains.
  SoilCounts soil_counts() const;
  MassLedger mass_ledger() const;
  /// Opens the account of the soil's energy, if none is open: it changes no bit and takes longer
  /// than the soil itself.
  void keep_soil_energy();
  /// Since it was opened, or since a snapshot was loaded; none when it was not.
  std::optional<SoilEnergy> soil_energy() const;
  /// Awake soil, one entry a particle, in a repeatable order.
  std::vector<ActiveParticle> loose_soil() const;
  WallTimes wall_times() const;
  /// Wall time of the soil by stage [s]: "p2g", "grid", "exchange", ...
  std::vector<std::pair<std::string, double>> soil_stage_times() const;

  /// Everything that decides how it goes on, for core/saved_state.h: `saved(world)`,
  /// `load_saved(bytes, world)`. Blocks until the state has been read from the device. Loads into a
  /// world built from the same scene, with the same samplers, only; whatever throws leaves the
  /// world half loaded, of no use but to be loaded again or destroyed.
  void visit(Archive& a);
  /// What the run started from (sim/snapshot.h): every parameter of the scene and the heights of
  /// its map.
  const scene::Parameters& start() const;
  std::uint64_t start_hash() const;
  /// Hash of state and start [hex]. Costs a pass over the state.
  std::string state_hash() const;
  /// Name and hash [hex] of the start and of every part by itself, to tell which of them differs.
  std::vector<std::pair<std::string, std::string>> hash_parts() const;

 private:
  friend WorldParts& parts(World& world);
  friend const WorldParts& parts(const World& world);
  std::unique_ptr<WorldParts> parts_;
};

}  // namespace navvy::sim
