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

/// Returns the faults in a scene's navvy:record elements that its reader cannot know, such as
/// unknown formats and layers, with their lines.
std::vector<Fault> check_records(const scene::Scene& scene);

/// Writes each record of the scene at its rate into the folder of the run.
///
/// A format of one instant becomes `maps/<name>_<number>.<extension>` (`terra`: a folder); the
/// number counts periods from time zero. `mcap` and `bag` become one file `<name>.mcap` or one
/// folder `<name>/` for the whole run. They hold the maps, and at a rate of their own the clock,
/// tf, odometry and joint states of all machines, and every sample of the typed arrays of the
/// world.
///
/// After each `restart` the files are called `<name>_2`, `<name>_3` and so on (skipping names of
/// other records), so that no file holds two states of one time and none is overwritten. Costs
/// nothing in steps in which no record is due, otherwise a map update and the file.
class MapRecorder {
 public:
  /// @throws InputError as check_records, FileError.
  MapRecorder(const session::Session& session, RunFolder& folder);
  ~MapRecorder();
  MapRecorder(const MapRecorder&) = delete;
  MapRecorder& operator=(const MapRecorder&) = delete;

  /// Writes what is due. Must be called at the start, after each step and after `restart`. @throws
  /// FileError.
  void observe();
  /// Closes open bags and begins new ones. Must be called when the world was put into another
  /// state. @throws FileError.
  void restart();
  /// Closes open bags, once. @throws FileError.
  void finish();

 private:
  /// One record of the scene.
  struct Stream;
  /// Opens the bag of a stream, if its format has one.
  void open(Stream& stream);
  /// Writes the samples of arrays that are newer than those in the stream's bag.
  void write_arrays(Stream& stream);
  const session::Session& session_;
  RunFolder& folder_;
  std::vector<std::unique_ptr<Stream>> streams_;
  // Names of files in use, without number and extension.
  std::set<std::string> taken_;
};

}  // namespace navvy::record
