// SPDX-License-Identifier: Apache-2.0
// Maps and bags that a scene asks for (navvy:record), written while it runs.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "record/run_folder.h"
#include "session/session.h"

namespace navvy::record {

/// Faults of a scene's navvy:record elements that its reader cannot know: names of formats and
/// layers. With their lines.
std::vector<Fault> check_records(const scene::Scene& scene);

/// Writes each record of the scene at its rate, into the run's folder: a format of one instant as
/// `maps/<name>_<number>.<extension>` (`terra` as a folder), the number counting periods from time
/// zero; `mcap` and `bag` as one file `<name>.mcap` or one folder `<name>/` over the whole run,
/// with clock, tf, odometry and joint states of all machines at a rate of their own. After each
/// `restart` the files are called `<name>_2`, `<name>_3`, ... (the next that is no record's): none
/// holds two states of one time, none is written over. Costs nothing in steps in which none is due;
/// then a map brought up to date and the file.
class MapRecorder {
 public:
  /// @throws InputError as check_records, FileError.
  MapRecorder(const session::Session& session, RunFolder& folder);
  ~MapRecorder();
  MapRecorder(const MapRecorder&) = delete;
  MapRecorder& operator=(const MapRecorder&) = delete;

  /// Called at the start, after each step and after `restart`. @throws FileError.
  void observe();
  /// The world was put into another state: closes what is open and begins anew. @throws FileError.
  void restart();
  /// Closes what is open, once. @throws FileError.
  void finish();

 private:
  struct Stream;
  void open(Stream& stream);
  /// Writes the samples of arrays that are newer than those in the stream's bag.
  void write_arrays(Stream& stream);
  const session::Session& session_;
  RunFolder& folder_;
  std::vector<std::unique_ptr<Stream>> streams_;
  std::set<std::string> taken_;  ///< what files are called, without number and extension
};

}  // namespace navvy::record
