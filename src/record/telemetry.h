// SPDX-License-Identifier: Apache-2.0
// telemetry.csv: one row per sample of every scalar output of the world.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "session/session.h"

namespace navvy::record {

/// Simulated time [s] as text of at most twelve digits: two steps of one run never share a stamp.
std::string time_stamp(double time);

/// Collects rows and replaces the file whole, so that a reader (or a kill) finds only complete rows.
///
/// The first line holds the channel names with units in brackets, then machine phases as text. Rewrites come at growing
/// distances (a tenth of the rows), so the total cost stays linear. Outputs that a sampler adds later are left out: add
/// samplers first.
class Telemetry {
 public:
  /// Writes nothing yet. The session must outlive it.
  Telemetry(const session::Session& session, std::string path);
  /// One row of what the outputs say now.
  void sample();
  /// Writes the file when enough rows have come since the last time, or always when `force`. @throws FileError.
  void checkpoint(bool force);
  std::size_t rows() const { return rows_; }

 private:
  const session::Session& session_;
  std::string path_;
  std::string text_;
  std::size_t channels_ = 0;  ///< outputs there were when the header was written
  std::size_t rows_ = 0, written_rows_ = 0;
};

}  // namespace navvy::record
