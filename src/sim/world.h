// SPDX-License-Identifier: Apache-2.0
// A running world: ground, soil and machines of a scene, stepped together.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/archive.h"
#include "heightfield/layered_ground.h"
#include "scene/parameters.h"
#include "scene/scene.h"
#include "sim/array_outputs.h"
#include "sim/channels.h"
#include "sim/machine_commands.h"
#include "sim/machines.h"
#include "sim/sampler.h"
#include "sim/soil_view.h"
#include "sim/world_hashes.h"
#include "sim/world_measurements.h"
#include "vehicle/physics_engine_factory.h"

namespace navvy::device {
class Device;
}

namespace navvy::sim {

/// Ground, soil and machines of one scene, with named inputs and outputs.
///
/// A world knows no operator and writes no file: its clients do that (session, record, `navvy`).
/// One `step` is one base step of fixed length. The same scene, inputs, device and driver give
/// bit-identical results. Lengths and poses are in the world frame W, z up, in SI units. Functions
/// are grouped by topic: `inputs` and `outputs` by name, `machines` to read, `commands` to drive,
/// `soil` to measure, `hashes` to compare runs. Not thread-safe.
///
///   device::Device device;
///   sim::World world(scene_io::load_scene("trench.sdf", control::step_kinds()), device);
///   const int boom = world.inputs().index("excavator/boom_joint/velocity");
///   const sim::ToolHandle bucket = world.machines().at("excavator").tool("bucket");
///   while (world.time() < 5) {
///     world.inputs().set(boom, 0.2);
///     world.step();
///   }
///   std::printf("%.0f N, %.0f kg\n", bucket.force().norm(), bucket.payload());
class World {
 public:
  /// Builds the ground from the scene (reads the heightmap file if it names one) and places the
  /// machines on it. `make_engine` makes the physics engine of the dynamic machines; Bullet
  /// without.
  /// @throws InputError for a scene that cannot be built, device::DeviceError for the device.
  World(scene::Scene description, device::Device& device,
        const vehicle::PhysicsEngineFactory& make_engine = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Returns the scene the world was built from. All indices follow its order of machines, joints
  /// and soils.
  const scene::Scene& description() const;
  /// Returns the parameters and map heights that the run started from (sim/snapshot.h).
  const scene::Parameters& start() const;
  /// Returns the base step [s]. Loading a snapshot sets the snapshot's step.
  double dt() const;
  /// Returns the longest base step that soil and scene allow [s]. A control rate shortens the step.
  double longest_step() const;
  /// Returns the number of base steps taken.
  std::uint64_t steps() const;
  /// Returns the simulated time [s], steps x dt.
  double time() const;

  /// Advances by one base step, then calls the samplers that are due. Blocks until the state is on
  /// the host.
  /// @throws SimulationError with step, time and cause; the state is then that of the fault.
  void step();

  /// Numbers to set by name. The list never changes.
  Inputs& inputs();
  const Inputs& inputs() const;
  /// Numbers to read by name. Samplers and `watch` append to the list.
  const Outputs& outputs() const;
  /// Appends pose, velocity and angular velocity of a link to the outputs. `link` is
  /// "machine/link": "excavator/boom" adds "excavator/boom/pose/x" to "/yaw", "/velocity/x",
  /// "/angular_velocity/x". Has no effect on a link that is watched already.
  /// @throws InputError for an unknown machine or link; the message names the nearest one.
  void watch(const std::string& link);
  /// Arrays that samplers publish, with time stamp, shape, unit and frame. Read them in place.
  const ArrayOutputs& arrays() const;
  /// Adds a sampler and takes its first sample at once. Its outputs are appended to the lists.
  /// @throws InputError for a name in use or an invalid rate.
  void add(std::unique_ptr<Sampler> sampler);

  /// Machines to read.
  Machines machines() const { return Machines(*parts_); }
  /// Machines to drive.
  MachineCommands commands() { return MachineCommands(*parts_); }

  /// Returns the resting ground. Loose soil lies beside it in soil().loose_soil().
  const heightfield::Ground& ground() const;
  /// Soil to measure.
  SoilView soil() const { return SoilView(*parts_); }
  /// Opens the soil's energy account if it is not open. Changes no result; costs more than the soil
  /// itself.
  void keep_soil_energy();
  /// Returns the wall time of stepping so far, by part [s].
  WallTimes wall_times() const;

  /// Visits all state that determines the future of a run, for core/saved_state.h:
  /// `saved(world)`, `load_saved(bytes, world)`. Blocks until the state has been read from the
  /// device. Loads only into a world built from the same scene, with the same samplers. A load that
  /// throws leaves the world half loaded: load again or destroy it.
  void visit(Archive& a);
  /// Hashes of state and start.
  WorldHashes hashes() const { return WorldHashes(*parts_); }

 private:
  friend WorldParts& parts(World& world);
  friend const WorldParts& parts(const World& world);
  std::unique_ptr<WorldParts> parts_;
};

}  // namespace navvy::sim
