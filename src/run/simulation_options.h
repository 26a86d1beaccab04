// SPDX-License-Identifier: Apache-2.0
// What a caller chooses for one simulation.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vehicle/physics_engine_factory.h"

namespace navvy::device {
class Device;
}
namespace navvy::session {
class Session;
}

namespace navvy::run {

/// Settings of a Simulation. The defaults simulate the scene as it is and write nothing.
struct SimulationOptions {
  // Device.
  /// OpenCL device as device::Device takes it: "cpu", "gpu", an index or a part of a name. Empty:
  /// NAVVY_DEVICE decides, else the first CPU.
  std::string device;
  /// Device to use in place of `device`, for several simulations in one process.
  std::shared_ptr<device::Device> shared_device;

  /// Makes the physics engine of the machines, as for sim::World. Empty: the built-in ones.
  vehicle::PhysicsEngineFactory make_engine;

  // Values that replace those of the scene.
  std::optional<double> duration;        ///< maximum simulated time [s]
  std::optional<double> telemetry_rate;  ///< rows of telemetry.csv [1/s]
  std::optional<bool> pictures;          ///< draw pictures at the rates of the scene's cameras
  /// Control steps that a controller outside asks for [1/s]. The base step divides their period.
  std::optional<double> control_rate;

  // Output.
  /// Folder of the results (record/recorder.h). Empty: no file is written. The results of an
  /// earlier run in it move to "<folder>.previous".
  std::string folder;
  double hash_every = 0;   ///< simulated time between rows of hashes.csv [s]; 0: no such file
  std::string scene_text;  ///< the scene as scene_io::load_scene resolves it, for scene.sdf
  std::vector<std::string> command;  ///< command line that started the run, for run.json
  std::string snapshot;              ///< file to save the state to; empty: none
  double snapshot_at = -1;           ///< simulated time of that snapshot [s]

  // Start.
  std::string resume;          ///< snapshot to continue from; empty: the start of the scene
  bool resume_anyway = false;  ///< also if the scene's parameters differ from the snapshot's

  // Measurements.
  std::vector<std::string> watch;  ///< links to observe, "machine/link" (sim::World::watch)
  bool soil_energy = false;        ///< keep the soil's energy account; up to three times as slow
  /// Adds samplers. Called with each new session before a state is loaded into it: once at the
  /// start, and again by a reset to another seed.
  std::function<void(session::Session&)> set_up;
  /// Receives messages about device and rates before the first step, one line each.
  std::function<void(const std::string&)> note;
};

}  // namespace navvy::run
