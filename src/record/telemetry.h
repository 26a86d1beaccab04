// SPDX-License-Identifier: Apache-2.0
// telemetry.csv and telemetry.npy: a table with one row per sample and one column per scalar output
// of the world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "record/record_file.h"
#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// Returns the simulated time `time` [s] as text with at most twelve significant digits. Two steps
/// of a run never have the same text.
std::string time_stamp(double time);

/// Writes one table twice, as telemetry.csv for people and as telemetry.npy for programs, one row
/// per sample. The cost of a row does not grow with the run.
///
/// The first line of the CSV holds the names of the world's scalar outputs with their units in
/// brackets. The last columns hold the program phase of each machine, as text. The fields of the
/// NPY have the same names without units: `time` as float64, outputs as float32, phases as text of
/// at most kPhaseBytes bytes. Outputs that are added to the world after the construction of this
/// object are not recorded.
class Telemetry {
 public:
  /// Longest phase in the NPY [bytes]; what is longer is cut.
  static constexpr std::size_t kPhaseBytes = 32;

  /// Prepares the two files without writing to them. Keeps a reference to `session`, which must
  /// outlive this object.
  Telemetry(const session::Session& session, std::string csv, std::string npy);
  /// Adds a row with the current values of all outputs to the buffers.
  /// @throws FileError if a buffer is full and cannot be written to its file.
  void sample();
  /// Writes the buffered rows to the files. If `end` is true, also waits until they are stored on
  /// the disk.
  /// @throws FileError if writing fails.
  void checkpoint(bool end);
  /// Continues in copies of the files.
  /// @throws FileError if the rows cannot be copied.
  void move_to(const std::string& csv, const std::string& npy);
  /// Returns the number of rows that were added, without the header.
  std::uint64_t rows() const { return rows_.rows(); }

 private:
  const session::Session& session_;
  RowFile rows_;
  RecordFile records_;
  /// Number of output columns in the header.
  std::size_t channels_;
  /// Current row as text and as bytes; kept to reuse their memory.
  std::string row_, record_;
};

}  // namespace navvy::record
