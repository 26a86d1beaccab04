// SPDX-License-Identifier: Apache-2.0
// A running world: ground, soil and machines of a scene, which are stepped together.
#pragma once

#include <cstdint>
#include <functional>
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
/// A world contains no operators and writes no files; its clients do (session, record, `navvy`).
/// `step` advances it by one base step of fixed length. The same scene, inputs, device and driver
/// give bit-identical results. Lengths and poses refer to the world frame W, whose z axis points
/// up, in SI units. Functions are grouped by topic: `inputs` and `outputs` access channels by name,
/// `machines` reads machines, `commands` commands them, `soil` measures the soil, and `hashes`
/// compares runs. Not thread-safe.
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
  /// Builds the ground of the scene, reading its heightmap file if it names one, and places the
  /// machines on it. `make_engine` creates the physics engine of the dynamic machines; if it is
  /// empty, they use Bullet. The device must outlive the world.
  /// @throws InputError for a scene that cannot be built; device::DeviceError if the device fails.
  World(scene::Scene description, device::Device& device,
        const vehicle::PhysicsEngineFactory& make_engine = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Returns the scene that the world was built from. Indices of machines, joints and soils refer
  /// to the lists in this scene.
  const scene::Scene& description() const;
  /// Returns the scene parameters that the run started from, with the hash of its map heights if
  /// the scene has a map (sim/snapshot.h).
  const scene::Parameters& start() const;
  /// Returns the length of the base step [s]. Loading a snapshot replaces it by the base step of
  /// the snapshot.
  double dt() const;
  /// Returns the longest base step that soil and scene allow [s]. A control rate in the scene makes
  /// the base step shorter.
  double longest_step() const;
  /// Returns the number of base steps taken since the start of the simulation.
  std::uint64_t steps() const;
  /// Returns the simulated time since the start of the simulation [s]: number of steps x base step.
  double time() const;

  /// Advances the world by one base step, then takes the samples that are due. Blocks until the new
  /// state is available on the host.
  /// @throws SimulationError with step, time and cause if the state becomes invalid; the world then
  /// keeps the invalid state, for analysis.
  void step();

  /// Returns the named inputs, to look them up and set them. No input is ever added or removed.
  Inputs& inputs();
  /// Returns the named inputs, to look them up.
  const Inputs& inputs() const;
  /// Returns the named outputs, to look them up and read them. Samplers and `watch` add outputs at
  /// the end of the list.
  const Outputs& outputs() const;
  /// Adds outputs for pose, velocity and angular velocity of a link. `link` has the form
  /// "machine/link": "excavator/boom" adds "excavator/boom/pose/x" to "/yaw", "/velocity/x" to
  /// "/z", and "/angular_velocity/x" to "/z". Has no effect if the link has these outputs already.
  /// @throws InputError for an unknown machine or link; the message names the most similar one.
  void watch(const std::string& link);
  /// Returns the arrays that samplers publish, with time stamp, shape, unit and frame, to read them
  /// without copying.
  const ArrayOutputs& arrays() const;
  /// Adds a sampler, appends its outputs to the lists, and takes its first sample.
  /// @throws InputError if one of its output names is in use or its rate is invalid.
  void add(std::unique_ptr<Sampler> sampler);

  /// Returns access to the machines, for reading.
  Machines machines() const { return Machines(*parts_); }
  /// Returns access to the machines, for commanding them.
  MachineCommands commands() { return MachineCommands(*parts_); }

  /// Returns the ground columns. Active soil is not part of them; soil().loose_soil() returns it.
  const heightfield::Ground& ground() const;
  /// Changes the ground columns before the first step by calling `change`, for example to begin
  /// with a site that is dug in part. @throws Error after the first step, or if `change` has not
  /// kept the mass of each soil; then the world can only be destroyed.
  void reshape(const std::function<void(heightfield::Ground&)>& change);
  /// Returns access to measurements of the soil.
  SoilView soil() const { return SoilView(*parts_); }
  /// Starts the soil's energy account, unless it was started before. The account does not change
  /// results, but it takes more time than the soil simulation itself.
  void keep_soil_energy();
  /// Returns the wall time that all steps so far have taken [s], by part.
  WallTimes wall_times() const;

  /// Visits all state that determines the future of a run, to hash, save or load it:
  /// `saved(world)`, `load_saved(bytes, world)` (core/saved_state.h). Blocks until the state has
  /// been read from the device. Loading requires a world that was built from the same scene and has
  /// the same samplers. If loading throws, the world is left partly loaded; load again or destroy
  /// it.
  void visit(Archive& a);
  /// Returns access to hashes of the current state and of the start of the run.
  WorldHashes hashes() const { return WorldHashes(*parts_); }

 private:
  friend WorldParts& parts(World& world);
  friend const WorldParts& parts(const World& world);
  std::unique_ptr<WorldParts> parts_;
};

}  // namespace navvy::sim
