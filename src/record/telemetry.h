// SPDX-License-Identifier: Apache-2.0
// telemetry.csv: a table with one row per sample and one column per scalar output of the world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// Returns the simulated time `time` [s] as text with at most twelve significant digits. Two steps
/// of a run never have the same text.
std::string time_stamp(double time);

/// Writes the table telemetry.csv, one row per sample. The cost of a row does not grow with the
/// run.
///
/// The first line holds the names of the world's scalar outputs with their units in brackets. The
/// last columns hold the program phase of each machine, as text. Outputs that are added to the
/// world after the construction of this object are not recorded.
class Telemetry {
 public:
  /// Prepares the file `path` without writing to it. Keeps a reference to `session`, which must
  /// outlive this object.
  Telemetry(const session::Session& session, std::string path);
  /// Adds a row with the current values of all outputs to the buffer.
  /// @throws FileError if the buffer is full and cannot be written to the file.
  void sample();
  /// Writes the buffered rows to the file. If `end` is true, also waits until they are stored on
  /// the disk.
  /// @throws FileError if writing fails.
  void checkpoint(bool end) { end ? file_.sync() : file_.flush(); }
  /// Continues in a copy of the file at `path`.
  /// @throws FileError if the rows cannot be copied.
  void move_to(const std::string& path) { file_.move_to(path); }
  /// Returns the number of rows that were added, without the header.
  std::uint64_t rows() const { return file_.rows(); }

 private:
  const session::Session& session_;
  RowFile file_;
  /// Number of output columns in the header.
  std::size_t channels_;
  /// Text of the current row; kept to reuse its memory.
  std::string row_;
};

}  // namespace navvy::record
