// SPDX-License-Identifier: Apache-2.0
// The run loop as a library, used by the `navvy` program, servers and language bindings.
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

/// Progress of a run.
struct RunProgress {
  /// Simulated time (`time`) and its maximum (`duration`) [s].
  double time = 0, duration = 0;
  /// Simulated time divided by wall time, since the Simulation object was constructed [-].
  double real_time_factor = 0;
  /// Estimated wall time until the maximum duration is reached [s].
  double remaining = 0;
  /// Number of active soil particles.
  int particles = 0;
  /// Number of completed digging cycles, summed over all machines.
  int cycles = 0;
  /// Number of pictures written so far.
  int pictures = 0;
  /// Name of the activity of the first machine; empty if there are no machines.
  std::string phase;
};

/// Functions that Simulation::run_to_end calls between two steps. Each may be empty.
struct LoopHooks {
  /// Called before each step. If it returns a text that is not empty, the run ends as interrupted;
  /// the text is the cause, such as the name of a signal.
  std::function<std::string()> interrupted;
  /// Called before each step, for example to set inputs. Ends the run by returning false.
  std::function<bool()> before_step;
  /// Called after each step with the progress of the run.
  std::function<void(const RunProgress&)> progress;
};

/// A running scene: a session with its OpenCL device, its initial state, and the recording of its
/// results.
///
/// The programs of the scene control the machines. Setting an input of a machine ends the control
/// by its program (see session::Session). The same scene, seed, inputs, device and driver give
/// bit-identical runs.
///
/// Results are written to SimulationOptions::folder only. Nothing is printed: messages go to
/// core/log.h. Not thread-safe.
///
///     run::Simulation simulation(scene_io::load_scene("trench.sdf", control::step_kinds()));
///     simulation.run_to_end();
///     double z = simulation.heights().sample(1.0, 2.0);
class Simulation {
 public:
  /// Builds the world of `scene`, and starts recording if the options name an output folder.
  /// @throws InputError for a scene, folder or snapshot that cannot be used; device::DeviceError;
  /// FileError. Results of an earlier run in the folder are not changed before all checks have
  /// passed.
  explicit Simulation(scene::Scene scene, SimulationOptions options = {});
  /// Ends the recording as `finish` does. Errors are logged.
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // Stepping.
  /// Advances the simulation by `n` base steps and records each of them. It may go on after the
  /// scene is `done`.
  /// @throws SimulationError or FileError. The recording is then closed with the status "failed",
  /// and failed.snapshot is written.
  void step(int n = 1);
  /// Advances the simulation until the scene is `done` or a hook ends the run, and then finishes
  /// it. Returns how the run ended. @throws as `step`.
  RunEnd run_to_end(const LoopHooks& hooks = {});
  /// Returns true if all programs have ended or the maximum duration is reached
  /// (session::Session::done).
  bool done() const;
  /// Ends the run: writes the final files and closes the output folder. Returns how the run ended.
  /// If `interrupted_by` is not empty, the run ends as interrupted with this cause. The simulation
  /// may continue afterwards, without recording. A second call, or a call without an output folder,
  /// writes nothing.
  /// @throws FileError for a result that could not be written.
  RunEnd finish(const std::string& interrupted_by = "");
  /// Closes the output folder with the status "failed" and the given cause, and writes
  /// failed.snapshot. Throws nothing: further errors are logged.
  void fail(const std::string& cause) noexcept;

  // State.
  /// Restores the state at the end of the constructor, which is that of the snapshot if the run was
  /// resumed from one. Tables in the output folder continue with the earlier time; recorded maps
  /// start new files.
  void reset();
  /// Restores the initial state of the scene with another seed, which changes encoder noise and
  /// hills without a seed of their own. The world is built again, so references into the old one
  /// become invalid. If `seed` is the current seed, this is `reset()`.
  /// @throws Error while an output folder is open or an observer is attached, as both belong to the
  /// old world.
  void reset(std::uint64_t seed);
  /// Saves the state to the file `path`, which is replaced atomically. @throws FileError.
  void save(const std::string& path) const;
  /// Restores a saved state of the same scene. If `anyway` is true, the parameters of the scene may
  /// differ from those in the file.
  /// @throws FileError or InputError; the state is then unchanged.
  void load(const std::string& path, bool anyway = false);
  /// Returns how often `reset` or `load` replaced the state.
  std::uint64_t replacements() const;

  // Inputs and outputs: numbers by name or index, in SI units (`navvy channels` lists them).
  /// Returns the names and units of all inputs. An input's position in the list is its index.
  const std::vector<sim::Channel>& inputs() const;
  /// Returns the names and units of all outputs. An output's position in the list is its index.
  const std::vector<sim::Channel>& outputs() const;
  /// Returns the index of the input called `name`. @throws InputError that suggests the most
  /// similar name.
  int input(const std::string& name) const;
  /// Returns the index of the output called `name`. @throws InputError that suggests the most
  /// similar name.
  int output(const std::string& name) const;
  /// Sets the input with index `input` to `value`, in SI units. Its machine no longer follows its
  /// program.
  /// @throws InputError for an unknown input or a value that is not finite.
  void set(int input, double value);
  /// Sets the input called `input` to `value`. @throws as `set` with an index.
  void set(const std::string& input, double value) { set(this->input(input), value); }
  /// Returns the current value of the output with index `output`, in SI units. @throws InputError
  /// for an unknown output.
  double get(int output) const;
  /// Returns the current value of the output called `output`. @throws InputError for an unknown
  /// output.
  double get(const std::string& output) const { return get(this->output(output)); }
  /// Gives a machine a new program (session::Session::order). @throws InputError as that function
  /// does, and without SimulationOptions::read_program.
  void order(const std::string& machine, const std::string& steps, bool now = false);
  /// Adds outputs for the pose and the velocities of a link, given as "machine/link". @throws
  /// InputError for an unknown link.
  void watch(const std::string& link);
  /// Returns the array outputs, such as scans, with time stamp, shape, unit and frame. The data are
  /// not copied.
  const sim::ArrayOutputs& arrays() const;

  // Ground and pictures.
  /// Returns an immutable view of the current terrain: resting columns and the loose soil on them,
  /// without soil in buckets and truck beds. The view may outlive the simulation. Takes one pass
  /// over the soil particles.
  heightfield::TerrainView heights() const;
  /// Returns at most 64 rectangles of columns that contain all changes of the terrain since the
  /// last call of this function. The first call returns the whole site. Empty if nothing changed.
  std::vector<heightfield::CellRect> changed();
  /// Draws the current view of the camera called `camera`. The picture is not written to the output
  /// folder.
  /// @throws InputError for an unknown camera, Error if pictures cannot be drawn.
  render::Image image(const std::string& camera);

  // Reports.
  /// Returns the simulated time [s].
  double time() const;
  /// Returns the progress of the run. Takes almost no time.
  RunProgress progress() const;
  /// Returns the text that summary.json would have if the run ended now. With `with_hash` it
  /// contains the hash of the state, which takes one pass over the state; otherwise `state_hash` is
  /// null.
  std::string summary(bool with_hash = true) const;
  /// Returns the folder of the results, also after they were saved in another one; empty without
  /// such a folder, and if it was removed or replaced.
  std::string results_folder() const;
  /// Returns the hash of everything that determines the further course of the run, as hexadecimal
  /// text.
  std::string state_hash() const;
  /// Returns the session. The reference is valid until `reset(seed)`.
  const session::Session& session() const;
  /// Returns the world of the session. The reference is valid until `reset(seed)`.
  const sim::World& world() const;

  /// Attaches an observer. It must stay alive until it is detached or the run ends.
  void attach(RunObserver& observer);
  /// Detaches an observer; no effect if it is not attached.
  void detach(RunObserver& observer);

 private:
  /// Session, recorder and observers of the simulation.
  struct State;
  /// Session, recorder and observers; never null.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::run
