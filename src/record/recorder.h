// SPDX-License-Identifier: Apache-2.0
// The results of a run, written so that a kill at any moment leaves either the old or the new file.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "record/run_folder.h"
#include "record/summary.h"
#include "render/image.h"
#include "session/session.h"

namespace navvy::record {

/// Options of a recording. The defaults are those of `navvy run`.
struct Options {
  /// Folder of the results. The results of an earlier run in it move to "<directory>.previous".
  std::string directory;
  /// Draws pictures at the rates of the scene's cameras.
  bool render = true;
  /// Simulated time between rows of hashes.csv [s]; 0: no such file.
  double hash_every = 0;
  /// Wall time between updates of telemetry and summary [s].
  double checkpoint = 2;
  /// The scene as scene_io::load_scene resolved it, for scene.sdf. Empty: no such file, and the
  /// folder cannot be run again.
  std::string scene_text;
  /// Command line that started the run, for run.json.
  std::vector<std::string> command;
};

/// Returns the wall time [s] that `simulated` more seconds take at `real_time_factor`. The result
/// is never negative, and 0 while the factor is still unknown (0).
double wall_time_left(double simulated, double real_time_factor);

/// Records a session into a folder.
///
/// Writes scene.sdf and run.json (run_info.h), summary.json (with the state's hash at the start and
/// at the end only), telemetry.csv, terrain_start.tif and terrain_end.tif; on request hashes.csv,
/// pictures frames/<camera>_<n>.png, arrays/<name>.npy of each array output (array_recorder.h) and
/// the records of the scene (map_recorder.h); after a failure failed.snapshot. Memory does not grow
/// with the run. Not thread-safe; draws on the calling thread.
class Recorder {
 public:
  /// Makes the folder and writes the files of the start. Uses `folder`, if given, which was locked
  /// before. Keeps a reference to `session`.
  /// @throws FileError, and InputError as RunFolder does.
  Recorder(session::Session& session, Options options, std::unique_ptr<RunFolder> folder = nullptr);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Samples, draws and writes all that is due. Call it after each step. @throws FileError, e.g. on
  /// a full disk.
  void observe();
  /// Continues after the session was put into another state. Recorded maps and bags begin new files
  /// (map_recorder.h), tables continue. @throws FileError.
  void restart();
  /// Writes the final files, once. `status` is one of RunStatus::status except "running"; "failed"
  /// also saves failed.snapshot. If a file cannot be written, the others still are, and the summary
  /// reports the run as failed. @throws FileError for that file, unless the run had failed before.
  void finish(const std::string& status, const std::string& message = "");
  /// Returns the text of summary.json as it would be now. The state's hash costs a pass over the
  /// state; without it `state_hash` is null.
  std::string summary(bool with_hash) const;
  /// Returns the status of the run: its wall times and the number of pictures so far.
  const RunStatus& status() const;
  /// Returns what a camera of the scene sees now; the picture is not written and not counted.
  /// @throws InputError for an unknown camera, Error when nothing can be drawn.
  render::Image draw(const std::string& camera);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::record
