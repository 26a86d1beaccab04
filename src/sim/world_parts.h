// SPDX-License-Identifier: Apache-2.0
// Parts of a world: solver, physics engines and their coupling. For sim's own sources and for tests
// that measure inside; a style test keeps this header out of the clients in src/.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "coupling/coupling.h"
#include "heightfield/layered_ground.h"
#include "scene/parameters.h"
#include "scene/scene.h"
#include "sim/array_outputs.h"
#include "sim/channels.h"
#include "sim/sampler.h"
#include "soil/solver.h"
#include "vehicle/encoder.h"
#include "vehicle/physics_engine.h"

namespace navvy::device {
class Device;
}

namespace navvy::sim {

// The facade that owns the parts.
class World;

/// Parts in the order of construction. Each refers to those above it, so it is neither copied nor
/// moved.
struct WorldParts {
  /// Builds the ground, places the machines on it, and activates and loads the soil that the scene
  /// asks for.
  /// @throws InputError for a scene that cannot be built, device::DeviceError for the device.
  WorldParts(scene::Scene world, device::Device& device,
             const vehicle::PhysicsEngineFactory& make_engine);
  WorldParts(const WorldParts&) = delete;
  WorldParts& operator=(const WorldParts&) = delete;

  /// Updates all encoders, after each step of the machines.
  void advance_encoders();
  /// Returns whether any machine has an encoder.
  bool has_encoders() const;

  /// Visits all state that determines the future of a run (World::visit).
  void visit(Archive& a);

  /// Returns the simulated time [s].
  double time() const { return static_cast<double>(steps) * dt; }

  /// The scene.
  scene::Scene description;
  heightfield::Ground ground;
  /// Physics engines of dynamic and of kinematic machines.
  std::unique_ptr<vehicle::PhysicsEngine> dynamic, kinematic;
  /// Soil solver, which changes `ground` as particles become active and come to rest.
  soil::Solver soil;
  /// Steps the four above and maps machines to engines.
  coupling::Coupling coupling;
  /// Encoders by machine of the scene; most have none.
  std::vector<vehicle::Encoders> encoders;
  /// Clients' view: numbers to set and to read, arrays to read.
  Inputs inputs;
  Outputs outputs;
  ArrayOutputs arrays;
  /// Samplers in the order in which they were added, which is the order of sampling, hash and
  /// snapshot.
  std::vector<std::unique_ptr<SamplerSlot>> samplers;
  /// Start of the run by name, and its hash. Neither ever changes.
  scene::Parameters start;
  std::uint64_t start_hash = 0;
  /// Longest base step that soil and scene allow [s].
  double longest_step = 0;
  /// Base step [s].
  double dt = 0;
  std::uint64_t steps = 0;

 private:
  /// Fills the machine's bed with the load that the scene gives it.
  void fill_bed(const coupling::ToolLoad& tool);
  /// Turns a rectangle of the ground into particles.
  void activate(const scene::ActiveSoil& active);
};

/// Checks the index of a hitch. @throws InputError for an index that is no hitch of the scene.
void require_hitch(const scene::Scene& scene, int hitch);

/// Returns the parts of a world: `parts(world).soil.particles()`.
WorldParts& parts(World& world);
const WorldParts& parts(const World& world);

}  // namespace navvy::sim
