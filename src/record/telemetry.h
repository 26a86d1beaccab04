// SPDX-License-Identifier: Apache-2.0
// telemetry.csv: one row per sample of every scalar output of the world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// Returns simulated time [s] as text with at most twelve digits. Two steps of a run never share
/// it.
std::string time_stamp(double time);

/// Appends a row of all scalar outputs for each sample. Its cost does not grow with the run.
///
/// The first line holds the channel names with units in brackets; the last columns are the phases
/// of the machines, as text. Outputs that are added after the construction are left out.
class Telemetry {
 public:
  /// Prepares the file and writes nothing yet. Keeps a reference to `session`.
  Telemetry(const session::Session& session, std::string path);
  /// Adds a row with the present values. @throws FileError when waiting rows cannot be written.
  void sample();
  /// Writes the waiting rows; with `end` also waits for the disk. @throws FileError.
  void checkpoint(bool end) { end ? file_.sync() : file_.flush(); }
  /// Returns the number of rows.
  std::uint64_t rows() const { return file_.rows(); }

 private:
  const session::Session& session_;
  RowFile file_;
  std::size_t channels_;  ///< number of outputs in the header
  std::string row_;       ///< buffer, reused by each row
};

}  // namespace navvy::record
