// SPDX-License-Identifier: Apache-2.0
// The run loop as a library: what the `navvy` program, servers and language bindings share.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "heightfield/cell_rect.h"
#include "heightfield/terrain_view.h"
#include "render/image.h"
#include "run/run_end.h"
#include "run/run_observer.h"
#include "run/simulation_options.h"
#include "scene/scene.h"
#include "session/session.h"
#include "sim/array_outputs.h"
#include "sim/channels.h"

namespace navvy::run {

/// Progress of a run. Costs nothing to read.
struct RunProgress {
  double time = 0, duration = 0;  ///< simulated time, and its maximum [s]
  double real_time_factor = 0;    ///< simulated time / wall time, since the simulation was made [-]
  double remaining = 0;           ///< wall time left if the run takes its full duration [s]
  int particles = 0;              ///< active soil particles
  int cycles = 0;                 ///< completed digging cycles of all machines
  int pictures = 0;               ///< written so far
  std::string phase;              ///< activity of the first machine; empty without machines
};

/// Functions by which the caller of Simulation::run_to_end takes part between two steps. Every
/// function may be empty.
struct LoopHooks {
  /// Asked before each step. A text that is not empty interrupts the run and names the cause, e.g.
  /// a signal.
  std::function<std::string()> interrupted;
  /// Called before each step, e.g. to set inputs. Returns false to end the run.
  std::function<bool()> before_step;
  /// Called after each step.
  std::function<void(const RunProgress&)> progress;
};

/// A scene that runs: a session with its device, its start state, and its recording.
///
/// Programs of the scene drive their machines; an input that is set takes its machine from its
/// program (session::Session). The same scene, seed, inputs, device and driver give bit-identical
/// runs. Writes files into SimulationOptions::folder only, and prints nothing: messages go to
/// core/log.h. Not thread-safe.
///
///     run::Simulation simulation(scene_io::load_scene("trench.sdf", control::step_kinds()));
///     simulation.run_to_end();
///     double z = simulation.heights().sample(1.0, 2.0);
class Simulation {
 public:
  /// Builds the world of `scene` and, with an output folder, starts recording.
  /// @throws InputError for a scene, folder or snapshot that cannot be used (all checked before
  /// results of an earlier run are touched), device::DeviceError, FileError.
  explicit Simulation(scene::Scene scene, SimulationOptions options = {});
  /// Closes the recording as `finish` does. Failures are logged.
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // Stepping.
  /// Takes `n` base steps, recording each, also beyond the end of the scene (`done`).
  /// @throws SimulationError or FileError; the recording is then closed as "failed", with
  /// failed.snapshot.
  void step(int n = 1);
  /// Steps until the scene is done or a hook ends the run, then finishes. @throws as `step`.
  RunEnd run_to_end(const LoopHooks& hooks = {});
  /// Returns true when the programs have ended or the duration is over (session::Session::done).
  bool done() const;
  /// Ends the run: writes the final files and closes the folder. A text in `interrupted_by` marks
  /// it as interrupted. The simulation can continue afterwards, without recording. Calling it
  /// again, or without a folder, only reports. @throws FileError for a result that could not be
  /// written.
  RunEnd finish(const std::string& interrupted_by = "");
  /// Closes the folder as "failed" with this cause, keeping failed.snapshot. Throws nothing:
  /// further failures are logged.
  void fail(const std::string& cause) noexcept;

  // State.
  /// Returns to the state that the constructor left. A snapshot that was resumed counts as the
  /// start. Tables of the folder continue with the earlier time, recorded maps begin new files.
  void reset();
  /// Returns to the start of the same scene with another seed: encoder noise and the hills that
  /// used the scene's seed change. Builds the world anew, so handles and references into it become
  /// invalid; with the present seed it is `reset()`.
  /// @throws Error while a folder is open or an observer is attached, as these belong to one
  /// ground.
  void reset(std::uint64_t seed);
  /// Saves the state to a file, atomically. @throws FileError.
  void save(const std::string& path) const;
  /// Continues from a saved state of the same scene. With `anyway` its parameters may differ.
  /// @throws FileError, InputError; the state is then as it was before.
  void load(const std::string& path, bool anyway = false);
  /// Number of times that `reset` or `load` replaced the state.
  std::uint64_t replacements() const;

  // Inputs and outputs: numbers by name or index, in SI units (`navvy channels` lists them).
  const std::vector<sim::Channel>& inputs() const;
  const std::vector<sim::Channel>& outputs() const;
  /// Returns the index of a named channel. @throws InputError that names the nearest one.
  int input(const std::string& name) const;
  int output(const std::string& name) const;
  /// Sets an input, which takes its machine from its program.
  /// @throws InputError for an unknown channel or a value that is not finite.
  void set(int input, double value);
  void set(const std::string& input, double value) { set(this->input(input), value); }
  /// Returns the present value of an output. @throws InputError for an unknown channel.
  double get(int output) const;
  double get(const std::string& output) const { return get(this->output(output)); }
  /// Adds pose and velocities of a link, "machine/link", to the outputs. @throws InputError.
  void watch(const std::string& link);
  /// Arrays that samplers publish, with stamp, shape, unit and frame. Read in place.
  const sim::ArrayOutputs& arrays() const;

  // Ground and pictures.
  /// Returns the terrain as maps show it: resting columns and the loose soil on them, heights in W
  /// [m]. The view is immutable and may outlive the simulation. Costs a pass over the particles.
  heightfield::TerrainView heights() const;
  /// Returns rectangles of columns, at most 64, that contain all changes of the terrain since the
  /// last call: the whole site the first time, none if nothing changed.
  std::vector<heightfield::CellRect> changed();
  /// Draws what a camera of the scene sees now. The picture is not written to the folder.
  /// @throws InputError for an unknown camera, Error when nothing can be drawn.
  render::Image image(const std::string& camera);

  // Reports.
  double time() const;  ///< simulated [s]
  RunProgress progress() const;
  /// Returns the text of summary.json as of now. The state's hash costs a pass over the state;
  /// without it `state_hash` is null.
  std::string summary(bool with_hash = true) const;
  /// Returns the hash of everything that determines the future of the run [hex].
  std::string state_hash() const;
  const session::Session& session() const;
  const sim::World& world() const;

  /// Attaches an observer, which must stay alive until it is detached or the simulation ends.
  void attach(RunObserver& observer);
  void detach(RunObserver& observer);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::run
