// SPDX-License-Identifier: Apache-2.0
// Parts of a world: soil solver, physics engines and their coupling. Only the sources of sim, and
// tests that measure inside a world, include this header; a style test checks that no client in
// src/ does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "coupling/coupling.h"
#include "heightfield/layered_ground.h"
#include "scene/parameters.h"
#include "scene/scene.h"
#include "sim/array_outputs.h"
#include "sim/channels.h"
#include "sim/link_forces.h"
#include "sim/sampler.h"
#include "soil/solver.h"
#include "vehicle/encoder.h"
#include "vehicle/physics_engine.h"
#include "vehicle/stability.h"

namespace navvy::device {
class Device;
}

namespace navvy::sim {

// Forward declared: the class that owns the parts and gives clients access to them.
class World;

/// Parts of a world in the order of their construction. Parts hold references to parts above them,
/// so the struct can be neither copied nor moved.
struct WorldParts {
  /// Builds the ground, places the machines on it, turns soil into particles where the scene asks
  /// for active soil, and loads the beds. `make_engine` creates the physics engine of the dynamic
  /// machines; if empty, Bullet is used.
  /// @throws InputError for a scene that cannot be built; device::DeviceError if the device fails.
  WorldParts(scene::Scene world, device::Device& device,
             const vehicle::PhysicsEngineFactory& make_engine);
  WorldParts(const WorldParts&) = delete;
  WorldParts& operator=(const WorldParts&) = delete;

  /// Updates all encoders from the current joint positions; must be called after each step of the
  /// machines.
  void advance_encoders();
  /// Returns true if any machine has an encoder.
  bool has_encoders() const;

  /// Visits all state that determines the future of a run, to hash, save or load it (World::visit).
  void visit(Archive& a);

  /// Returns the simulated time since the start of the simulation [s].
  double time() const { return static_cast<double>(steps) * dt; }

  /// Scene that the world was built from.
  scene::Scene description;
  /// Ground columns of the site.
  heightfield::Ground ground;
  /// Physics engine of the dynamic machines, and that of the kinematic machines. Neither is null.
  std::unique_ptr<vehicle::PhysicsEngine> dynamic, kinematic;
  /// Soil solver. It changes `ground` when columns become particles and when particles become
  /// columns again.
  soil::Solver soil;
  /// Coupling that steps ground, physics engines and soil together. It maps each machine of the
  /// scene to its engine and its index there.
  coupling::Coupling coupling;
  /// Encoders of each machine, in the scene's order. Most machines have none.
  std::vector<vehicle::Encoders> encoders;
  /// Forces on links with a force input.
  LinkForces forces;
  /// Named inputs, which clients set.
  Inputs inputs;
  /// Named scalar outputs, which clients read.
  Outputs outputs;
  /// Named arrays, which samplers fill and clients read.
  ArrayOutputs arrays;
  /// Samplers in the order in which they were added. They are sampled, hashed and saved in this
  /// order.
  std::vector<std::unique_ptr<SamplerSlot>> samplers;
  /// Parameters and map hash that the run started from (start_of in sim/snapshot.h). Never changes
  /// after construction.
  scene::Parameters start;
  /// Hash of `start`. Never changes after construction.
  std::uint64_t start_hash = 0;
  /// Longest base step that soil and scene allow [s].
  double longest_step = 0;
  /// Length of the base step [s].
  double dt = 0;
  /// Number of base steps taken since the start of the simulation.
  std::uint64_t steps = 0;
  /// Payload [kg] of each tool, in the order of Coupling::tools, and stability of each machine, in
  /// the order of the scene, once a reader has asked for them in the current state. They save the
  /// passes over particles and links when several outputs ask. Not part of the state.
  mutable std::vector<std::optional<double>> payloads;
  mutable std::vector<std::optional<vehicle::Stability>> stabilities;
  /// Drops payloads and stabilities of the state before.
  void forget_values();

 private:
  /// Fills the bed of a machine with the initial load that the scene specifies. Has no effect if
  /// `tool` is not a bed or there is no load.
  void fill_bed(const coupling::ToolLoad& tool);
  /// Turns the ground in a box of initially active soil into particles.
  void activate(const scene::ActiveSoil& active);
};

/// Checks that `hitch` is an index into scene::Scene::hitches.
/// @throws InputError if it is not.
void require_hitch(const scene::Scene& scene, int hitch);

/// Returns the parts of a world, for example `parts(world).soil.particles()`.
WorldParts& parts(World& world);
/// Returns the parts of a world for reading.
const WorldParts& parts(const World& world);

}  // namespace navvy::sim
