// SPDX-License-Identifier: Apache-2.0
// Records the maps and bags that a scene asks for (navvy:record elements) during a run.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "record/run_folder.h"
#include "record/sensor_topics.h"
#include "session/session.h"

namespace navvy::record {

/// Returns the errors in a scene's navvy:record elements that the scene reader cannot find, such as
/// unknown formats and layers. Each error gives file and line.
std::vector<Fault> check_records(const scene::Scene& scene);

/// Writes the maps and bags that the scene asks for into the run's folder.
///
/// Each navvy:record element of the scene has a format and a rate. A format for single maps gives
/// one file `maps/<name>_<number>.<extension>` per map (for `terra`, a folder); <number> is the
/// number of periods since time zero. The formats `mcap` and `bag` give one file `<name>.mcap` or
/// one folder `<name>/` for the whole run. It contains the maps and, at a rate of its own, the
/// clock and the machines (MachineTopics). It also contains every reading of sensors (SensorTopics)
/// and every sample of the world's other arrays.
///
/// After each call of `restart`, the files are named `<name>_2`, `<name>_3` and so on, where names
/// of other records are skipped. No file then contains two states of the same time, and none is
/// overwritten. A step in which no record is due costs nothing; otherwise the cost is an update of
/// the map and writing the file.
class MapRecorder {
 public:
  /// Prepares all records of the session's scene and opens their bags, which get the readings of
  /// `sensors` too. `session` and `folder` must outlive this object.
  /// @throws InputError with the errors of check_records; FileError if a file cannot be created.
  MapRecorder(const session::Session& session, RunFolder& folder,
              std::vector<SensorStream> sensors = {});
  ~MapRecorder();
  MapRecorder(const MapRecorder&) = delete;
  MapRecorder& operator=(const MapRecorder&) = delete;

  /// Writes the maps, machine states and array samples that are due. Must be called at the start of
  /// the run, after each step and after `restart`.
  /// @throws FileError if a file cannot be written.
  void observe();
  /// Closes the open bags and begins new ones. Must be called after the world was put into another
  /// state, for example by loading a snapshot.
  /// @throws FileError if a file cannot be written.
  void restart();
  /// Closes the open bags.
  /// @throws FileError if a file cannot be written.
  void finish();

 private:
  /// One navvy:record element of the scene with its current files.
  struct Stream;
  /// Opens a new bag for the record, if its format is that of a bag.
  void open(Stream& stream);
  /// Writes to the record's bag all array samples that the bag does not contain yet.
  void write_arrays(Stream& stream);
  const session::Session& session_;
  RunFolder& folder_;
  /// Sensors whose readings go into bags.
  const std::vector<SensorStream> sensors_;
  /// One entry per navvy:record element, in the scene's order.
  std::vector<std::unique_ptr<Stream>> streams_;
  /// Names that files of the scene's records use or have used, without number and extension.
  std::set<std::string> taken_;
};

}  // namespace navvy::record
