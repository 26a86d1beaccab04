// SPDX-License-Identifier: Apache-2.0
// telemetry.csv: one row per sample of every scalar output of the world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// Simulated time [s] as text of at most twelve digits: two steps of one run never share a stamp.
std::string time_stamp(double time);

/// Appends a row for each sample (record/row_file.h): what it costs, in memory and on disk, does
/// not grow with the run.
///
/// The first line holds the channel names with units in brackets, then machine phases as text.
/// Outputs that a sampler adds later are left out: add samplers first.
class Telemetry {
 public:
  /// Writes nothing yet. The session must outlive it.
  Telemetry(const session::Session& session, std::string path);
  /// One row of what the outputs say now. @throws FileError when many rows wait and the disk takes
  /// none.
  void sample();
  /// Appends what waits to the file; at the `end` also waits until the disk has it. @throws
  /// FileError.
  void checkpoint(bool end) { end ? file_.sync() : file_.flush(); }
  std::uint64_t rows() const { return file_.rows(); }

 private:
  const session::Session& session_;
  RowFile file_;
  std::size_t channels_;  ///< outputs there were when the header was written
  std::string row_;       ///< the one being made; kept, so that rows take no memory anew
};

}  // namespace navvy::record
