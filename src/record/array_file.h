// SPDX-License-Identifier: Apache-2.0
// A NumPy file to which one record is appended for each published value of an array.
#pragma once

#include <cstdint>
#include <string>

#include "record/record_file.h"
#include "sim/array_outputs.h"

namespace navvy::record {

/// Appends the published values of one array to a .npy file (record_file.h).
///
/// The fields of a record are `sequence` (uint64), `time_s` [s], `position_m` (3 numbers) and
/// `quaternion_wxyz` (4 numbers) for the pose of the array's frame in W, and `values` with the
/// shape and element type of the array. Records are in the order of publication.
class ArrayFile {
 public:
  /// Prepares the file `path` for values of the array `channel`, without writing to it.
  ArrayFile(std::string path, const sim::ArrayChannel& channel);

  /// Appends the current value of the array to the buffer.
  /// @throws FileError if the buffer is full and cannot be written.
  void add(const sim::ArrayView& value);
  /// Writes the buffered records to the file.
  /// @throws FileError if writing fails.
  void flush() { file_.flush(); }
  /// Writes the buffered records and waits until the file is stored on the disk.
  /// @throws FileError if writing fails.
  void sync() { file_.sync(); }
  /// Continues in a copy of the file at `path`.
  /// @throws FileError if the records cannot be copied.
  void move_to(const std::string& path) { file_.move_to(path); }
  /// Returns the number of records that were added.
  std::uint64_t records() const { return file_.records(); }

 private:
  RecordFile file_;
  /// The current record; kept to reuse its memory.
  std::string record_;
};

}  // namespace navvy::record
