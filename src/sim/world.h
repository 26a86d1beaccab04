// SPDX-License-Identifier: Apache-2.0
// A running world: ground, soil and machines of a scene, stepped together.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "core/state_io.h"
#include "coupling/coupling.h"
#include "device/device.h"
#include "heightfield/ground.h"
#include "scene/frame.h"
#include "scene/world.h"
#include "sim/channels.h"
#include "soil/solver.h"
#include "vehicle/engine.h"

namespace navvy::sim {

/// Ground, soil and machines of one scene with named inputs and outputs.
///
/// Knows no operator and writes no file: those are its clients (sim/session.h, record, the `navvy` program). One `step`
/// is one base step of fixed length; the same scene, inputs, device and driver give the same bits. Not thread-safe.
class World {
 public:
  /// Builds the ground from the scene (reads the heightmap file if it names one).
  /// @throws InputError for what cannot be built, device::DeviceError for the device.
  World(scene::World description, device::Device& device);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const scene::World& description() const;
  double dt() const;  ///< base step [s]
  std::uint64_t steps() const;
  double time() const;  ///< steps x dt [s]

  /// Advances by one base step. @throws SimulationError with step, time and cause; the state is then that of the fault.
  void step();

  const std::vector<Channel>& inputs() const;
  const std::vector<Channel>& outputs() const;
  /// Index of a named channel. @throws InputError that names the nearest known one.
  int input(const std::string& name) const;
  int output(const std::string& name) const;
  void set(int input, double value);
  double get(int output) const;
  void set(const std::string& name, double value) { set(input(name), value); }
  double get(const std::string& name) const { return get(output(name)); }

  // Direct access for operators and recorders; indices are those of description().machines.
  void set_joint(int machine, int joint, const vehicle::JointInput& input);
  void set_drive(int machine, const vehicle::DriveInput& input);
  vehicle::DriveInput drive(int machine) const;
  vehicle::JointState joint(int machine, int joint) const;
  vehicle::LinkState link(int machine, int link) const;
  vehicle::WheelState wheel(int machine, int wheel) const;
  vehicle::PumpState pump(int machine) const;
  double work(int machine) const;  ///< [J]
  const heightfield::Ground& ground() const;
  const soil::Solver& soil() const;
  soil::Solver& soil();
  const coupling::Coupling& coupling() const;
  const vehicle::Engine& engine(int machine) const;
  int engine_index(int machine) const;

  void hash(StateHash& hash) const;
  std::string state_hash() const;  ///< hex
  /// Name and hash [hex] of every part by itself, to tell which of them differs.
  std::vector<std::pair<std::string, std::string>> hash_parts() const;
  void save(StateWriter& writer) const;
  /// Into a world built from the same scene. @throws InputError when the snapshot does not fit.
  void load(StateReader& reader);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::sim
