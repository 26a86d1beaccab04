// SPDX-License-Identifier: Apache-2.0
// The arrays that samplers publish, in the run's folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "record/array_file.h"
#include "record/run_folder.h"
#include "session/session.h"

namespace navvy::record {

/// Records every published value of every array of a world.
///
/// An array named "excavator/lidar" goes to `arrays/excavator/lidar.npy` (array_file.h);
/// `arrays/index.json` lists file, type, shape, unit, frame, rate and meaning of each array. A
/// world without arrays gets neither, and costs nothing.
class ArrayRecorder {
 public:
  /// Keeps references to both, which must outlive this object.
  ArrayRecorder(const session::Session& session, RunFolder& folder);

  /// Records the values that are new since the last call. Call after each step.
  /// @throws FileError; Error for an array whose name cannot be the name of a file.
  void observe();
  /// Continues after the world was put into another state: a value that is shown there already is
  /// not recorded again.
  void restart();
  /// Writes the waiting records; with `end` also waits for the disk. @throws FileError.
  void checkpoint(bool end);

 private:
  struct Stream {
    std::unique_ptr<ArrayFile> file;
    std::uint64_t sequence = 0;  ///< of the last recorded value
  };
  void open_new();

  const session::Session& session_;
  RunFolder& folder_;
  /// One stream per array, in the order of the world.
  std::vector<Stream> streams_;
};

}  // namespace navvy::record
