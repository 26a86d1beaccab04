// SPDX-License-Identifier: Apache-2.0
// Everything a run leaves behind, written so that a kill at any moment leaves the old or the new
// file.
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

/// What a caller wants of a run's folder; defaults are those of `navvy run`.
struct Options {
  /// Results go here; what an earlier run wrote there moves to "<directory>.previous".
  std::string directory;
  bool render = true;
  double hash_every = 0;  ///< simulated time between rows of hashes.csv [s]; 0: no such file
  double checkpoint = 2;  ///< wall time between rewrites of telemetry and summary [s]
  /// The scene as scene_io::load_scene wrote it out, for scene.sdf; empty: no such file, the folder
  /// cannot be run again.
  std::string scene_text;
  std::vector<std::string> command;  ///< that started the run, for run.json
};

/// Writes scene.sdf and run.json (run_info.h), summary.json (with the state's hash at the start and
/// at the end only), telemetry.csv, hashes.csv when asked, terrain_start.tif, terrain_end.tif,
/// frames/<camera>_<n>.png, arrays/<name>.npy of every array output (array_recorder.h), what the
/// scene records (map_recorder.h) and, after a failure, failed.snapshot. Not thread-safe; draws on
/// the calling thread.
class Recorder {
 public:
  /// Makes the directory and writes what is known at the start; a `folder` that was taken before is
  /// used in its place.
  /// @throws FileError, and InputError as RunFolder does.
  Recorder(session::Session& session, Options options, std::unique_ptr<RunFolder> folder = nullptr);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Called after each step: samples, draws and writes what is due. @throws FileError (disk full).
  void observe();
  /// Called when the session was put into another state, an earlier one or any other: recorded maps
  /// and bags begin new files (map_recorder.h), tables go on. @throws FileError.
  void restart();
  /// Writes the final files, once; later calls do nothing. `status` is one of RunStatus::status but
  /// "running"; after a failure also the snapshot of the last state. A file that cannot be written
  /// makes the run a failed one, whose summary says so.
  /// @throws FileError for that file, unless the run had failed before.
  void finish(const std::string& status, const std::string& message = "");
  /// Returns the text of summary.json as it would be now. The state's hash costs a pass over the
  /// state; without it `state_hash` is null.
  std::string summary(bool with_hash) const;
  /// Returns how the run stands: its times and the number of pictures so far.
  const RunStatus& status() const;
  /// Returns what a camera of the scene sees now; the picture is not written and not counted.
  /// @throws Error when nothing can be drawn, InputError for a name that is no camera's.
  render::Image draw(const std::string& camera);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::record
