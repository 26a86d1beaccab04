// SPDX-License-Identifier: Apache-2.0
// What a world is made of: solver, engines and the exchange between them. For sim's own sources and
// for tests that measure inside; a style test keeps this header out of the clients in src/.
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

// The façade that owns the parts.
class World;

/// The parts in the order in which they are built: each refers to those above it, so it is neither
/// copied nor moved.
struct WorldParts {
  /// Lays the ground, places the machines on it, wakes and loads the soil that the scene says.
  /// @throws InputError for what cannot be built, device::DeviceError for the device.
  WorldParts(scene::Scene world, device::Device& device);
  WorldParts(const WorldParts&) = delete;
  WorldParts& operator=(const WorldParts&) = delete;

  /// All encoders look at their joints, after each step of the machines.
  void advance_encoders();
  bool has_encoders() const;

  double time() const { return static_cast<double>(steps) * dt; }  ///< [s]

  /// What was asked for.
  scene::Scene description;
  heightfield::Ground ground;
  /// Machines with masses, and machines that move as told.
  std::unique_ptr<vehicle::PhysicsEngine> dynamic, kinematic;
  /// The particles, which change `ground` as they wake and rest.
  soil::Solver soil;
  /// Steps the four above; knows which engine has which machine.
  coupling::Coupling coupling;
  /// By machine of the scene; most have none.
  std::vector<vehicle::Encoders> encoders;
  /// What clients see: numbers to set and to read, arrays to read.
  Inputs inputs;
  Outputs outputs;
  ArrayOutputs arrays;
  /// In the order in which they were added, which is that of sampling, hash and snapshot.
  std::vector<std::unique_ptr<SamplerSlot>> samplers;
  /// What the run starts from, by name, and its hash: taken once, as neither ever changes.
  scene::Parameters start;
  std::uint64_t start_hash = 0;
  double longest_step = 0;  ///< that soil and scene allow [s]
  double dt = 0;            ///< base step [s]
  std::uint64_t steps = 0;

 private:
  /// Puts the load that the scene gives this machine into its bed.
  void fill_bed(const coupling::ToolLoad& tool);
  /// Turns a rectangle of the ground into particles.
  void wake(const scene::ActiveSoil& active);
};

/// The parts of a world: `parts(world).soil.particles()`.
WorldParts& parts(World& world);
const WorldParts& parts(const World& world);

}  // namespace navvy::sim
