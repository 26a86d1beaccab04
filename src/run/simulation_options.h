// SPDX-License-Identifier: Apache-2.0
// Options of a simulation.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/planners.h"
#include "record/particle_record.h"
#include "record/picture_format.h"
#include "vehicle/physics_engine_factory.h"

namespace navvy::device {
/// An OpenCL device (device/device.h).
class Device;
}  // namespace navvy::device
namespace navvy::session {
/// A world with the operators of its machines (session/session.h).
class Session;
}  // namespace navvy::session

namespace navvy::run {

/// Options of a Simulation. With the defaults, the scene is simulated as it is and nothing is
/// written.
struct SimulationOptions {
  // Device.
  /// OpenCL device as described at device::Device: "cpu", "gpu", an index, or a part of a name.
  /// Empty: the environment variable NAVVY_DEVICE selects it, or else the first CPU is used.
  std::string device;
  /// Device that is used instead of `device`, so that several simulations in one process can share
  /// it. Null: the simulation opens its own.
  std::shared_ptr<device::Device> shared_device;

  /// Function that makes the physics engine of the machines (see sim::World). Empty: the built-in
  /// engines are used.
  vehicle::PhysicsEngineFactory make_engine;

  // Values that replace those of the scene.
  /// Maximum simulated time [s]. No value: that of the scene is used.
  std::optional<double> duration;
  /// Rows of telemetry.csv per simulated second [1/s]. No value: the rate in the scene is used.
  std::optional<double> telemetry_rate;
  /// True to draw pictures at the rates of the scene's cameras, false to draw none. No value: the
  /// setting in the scene is used.
  std::optional<bool> pictures;
  /// Form in which pictures are written to the output folder.
  record::PictureFormat picture_format = record::PictureFormat::kAuto;
  /// Number of control steps of an external controller per simulated second [1/s]. The base step is
  /// chosen so that it divides the control period. No value: the rate in the scene is used.
  std::optional<double> control_rate;

  // Output.
  /// Output folder (record/recorder.h). Empty: no file is written. Results of an earlier run in the
  /// folder are moved to "<folder>.previous".
  std::string folder;
  /// True to write replay.jsonl, from which `navvy report` shows the run again.
  bool replay = true;
  /// Simulated time between two rows of hashes.csv [s]; 0: the file is not written.
  double hash_every = 0;
  /// Active soil that is written to particles/ in the output folder; by default none.
  record::ParticleRecord particles;
  /// Text that is recorded as scene.sdf: the scene with all changes, as scene_io::load_scene
  /// returns it.
  std::string scene_text;
  /// Command line that started the run, which is recorded in run.json.
  std::vector<std::string> command;
  /// File to which the state is saved at `snapshot_at`; empty: none.
  std::string snapshot;
  /// Simulated time at which `snapshot` is saved [s]. At a negative time it is saved before the
  /// first step.
  double snapshot_at = -1;

  // Start.
  /// Snapshot from which the run continues; empty: the run begins with the initial state of the
  /// scene.
  std::string resume;
  /// True to continue from a snapshot even if its scene parameters differ from those of the scene.
  bool resume_anyway = false;

  // Measurements.
  /// Links, given as "machine/link", whose pose and velocities are added to the outputs
  /// (sim::World::watch).
  std::vector<std::string> watch;
  /// Function that reads programs for Simulation::order, usually scene_io::ordered_program_reader;
  /// empty: none can be ordered.
  control::ReadProgram read_program;
  /// True to record the energy balance of the soil (`--energy`), which makes the soil up to three
  /// times slower.
  bool soil_energy = false;
  /// Function that adds array samplers to a new session. Called before a state is loaded into the
  /// session: once in the constructor, and again when Simulation::reset is called with another
  /// seed.
  std::function<void(session::Session&)> set_up;
  /// Function that receives messages about the device and the rates before the first step, one line
  /// each.
  std::function<void(const std::string&)> note;
};

}  // namespace navvy::run
