// SPDX-License-Identifier: Apache-2.0
// Records the arrays that samplers publish as NumPy files in the run's folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "record/array_file.h"
#include "record/row_file.h"
#include "record/run_folder.h"
#include "session/session.h"

namespace navvy::record {

/// Records every published value of every array of a world.
///
/// An array named "excavator/grid" is written to `arrays/excavator/grid.npy` (array_file.h). The
/// array "ranges" of the sensor "laser" of "robot" is written to `sensors/robot/laser/ranges.npy`,
/// beside an `index.csv` with one row per reading: its number, the times of its measurement and of
/// its delivery, and the latency between them. Pictures of its colour and label cameras are PNG
/// files instead, one for each reading, such as `sensors/robot/eye/image_000001.png`. The file
/// `arrays/index.json` lists file, element type, shape, unit, frame, rate and meaning of each
/// array. None of them is written for a world without arrays.
class ArrayRecorder {
 public:
  /// Keeps references to `session` and `folder`, which must outlive this object.
  ArrayRecorder(const session::Session& session, RunFolder& folder);

  /// Records the values that were published since the last call. Must be called after each step.
  /// @throws FileError if a file cannot be written; Error for an array whose name cannot be a file
  /// name.
  void observe();
  /// Continues after the world was put into another state, for example by loading a snapshot. Array
  /// values that are part of the loaded state are not recorded again.
  void restart();
  /// Writes the buffered records to the files. If `end` is true, also waits until they are stored
  /// on the disk.
  /// @throws FileError if writing fails.
  void checkpoint(bool end);
  /// Continues in copies of its files in the folder, which has moved out (RunFolder::move_out).
  /// @throws FileError if a file cannot be copied.
  void move_out();

 private:
  /// Output file of one array, and the last value that was written to it.
  struct Stream {
    /// Open file that receives the array's values; null if they are written as pictures.
    std::unique_ptr<ArrayFile> file;
    /// Sequence number of the last recorded value; 0 if none was recorded.
    std::uint64_t sequence = 0;
    /// Path in the run's folder; of pictures with "{reading:06}" for the number of the reading.
    std::string name;
    /// List of a sensor's readings; only with the first array of a sensor.
    std::unique_ptr<RowFile> index = nullptr;
    /// Path of that list in the run's folder.
    std::string index_name = "";
  };
  /// Opens files for arrays that were added to the world since the last call, and updates the
  /// index.
  void open_new();
  /// Writes a reading of a camera as a PNG file.
  void write_picture(const Stream& stream, const sim::ArrayView& value);
  /// Writes the list of all arrays.
  void write_index();

  const session::Session& session_;
  RunFolder& folder_;
  /// One entry per array, in the order of the world's arrays.
  std::vector<Stream> streams_;
};

}  // namespace navvy::record
