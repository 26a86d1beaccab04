// SPDX-License-Identifier: Apache-2.0
// Records the results of a run. Every file is written so that a kill at any moment leaves a valid
// file, either the old or the new one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "record/particle_record.h"
#include "record/picture_files.h"
#include "record/run_folder.h"
#include "record/summary.h"
#include "render/image.h"
#include "session/session.h"

namespace navvy::record {

/// Options of a recording. The defaults are those of `navvy run`.
struct Options {
  /// Folder for the results. The results of an earlier run in this folder are moved to
  /// "<directory>.previous".
  std::string directory;
  /// If true, pictures are drawn at the rates of the scene's cameras.
  bool render = true;
  /// If true, replay.jsonl is written, from which `navvy report` shows the run again.
  bool replay = true;
  /// Form in which pictures are written.
  PictureFormat picture_format = PictureFormat::kAuto;
  /// Interval of simulated time between two rows of hashes.csv [s]; 0 means that the file is not
  /// written.
  double hash_every = 0;
  /// Active soil to write as files; by default none.
  ParticleRecord particles;
  /// Minimum wall time between two updates of the telemetry and summary files [s].
  double checkpoint = 2;
  /// Text of the scene with all included files inserted, as scene_io::load_scene returns it, for
  /// scene.sdf. If empty, scene.sdf is not written and the run cannot be repeated from its folder.
  std::string scene_text;
  /// Command line that started the run, beginning with the program, for run.json.
  std::vector<std::string> command;
  /// Name of the schedule of the soil's kernels (sim::soil_schedule), for run.json.
  std::string schedule;
};

/// Returns the estimated wall time [s] for `simulated` more seconds of simulated time at the speed
/// `real_time_factor` (simulated time / wall time). Returns 0 if the factor is not known yet (0) or
/// `simulated` is negative.
double wall_time_left(double simulated, double real_time_factor);

/// Records the results of a session into a folder.
///
/// It writes scene.sdf and run.json (run_info.h), summary.json, telemetry.csv and telemetry.npy,
/// terrain_start.tif and terrain_end.tif. The summary contains the hash of the state only at the
/// start and at the end of the run. replay.jsonl (replay_recorder.h) shows it again. On request it
/// also writes hashes.csv, pictures in frames/ (picture_files.h), each array output as
/// arrays/<name>.npy (array_recorder.h), the active soil in particles/ (particle_recorder.h), and
/// the maps and bags that the scene asks for (map_recorder.h). If operators have planned paths, it
/// writes paths.csv, and after a failure failed.snapshot. The memory use does not grow with the
/// run. Not thread-safe; pictures are drawn on the calling thread and encoded on another one.
class Recorder {
 public:
  /// Creates the folder and writes the files for the start of the run. `folder` is a run folder
  /// that was locked before, or null to lock Options::directory. Keeps a reference to `session`,
  /// which must outlive this object.
  /// @throws FileError if a file cannot be written; InputError if the folder cannot be used
  /// (RunFolder).
  Recorder(session::Session& session, Options options, std::unique_ptr<RunFolder> folder = nullptr);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Records everything that is due in the current step: telemetry, arrays, pictures, hashes,
  /// maps and particles. Must be called after each step.
  /// @throws FileError if a file cannot be written, for example on a full disk.
  void observe();
  /// Continues the recording after the session was put into another state, for example by loading a
  /// snapshot. Recorded maps, bags and particles begin new files (map_recorder.h); tables continue
  /// in the same files.
  /// @throws FileError if a file cannot be written.
  void restart();
  /// Writes the final files; only the first call has an effect. `status` is a value of
  /// RunStatus::status other than "running", and `message` is the cause of a failure or
  /// interruption. With the status "failed", failed.snapshot is written as well. If a file cannot
  /// be written, the others still are, and the summary reports the run as failed.
  /// @throws FileError for the first file that could not be written, unless `status` is "failed".
  void finish(const std::string& status, const std::string& message = "");
  /// Returns the text that summary.json would have now. The hash of the state costs a pass over the
  /// whole state; if `with_hash` is false, `state_hash` is null.
  std::string summary(bool with_hash) const;
  /// Returns the folder of the results, also after they were saved in another one; empty if it was
  /// removed or replaced.
  std::string folder() const;
  /// Returns the status of the run so far, with its wall times and the number of pictures.
  const RunStatus& status() const;
  /// Returns a picture of the world's current state from the scene camera called `camera`. The
  /// picture is neither written to a file nor counted.
  /// @throws InputError if there is no such camera; Error if no picture can be drawn.
  render::Image draw(const std::string& camera);

 private:
  /// All data of the recording: session, options, open files and status.
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::record
