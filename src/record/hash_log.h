// SPDX-License-Identifier: Apache-2.0
// hashes.csv: what every part of the state hashed to, at fixed distances of simulated time.
#pragma once

#include <cstdint>
#include <string>

#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// One row per distance: step, time [s], the whole state, then part by part, so that two runs
/// compared line by line show when they parted and which part did first. Each row costs a pass over
/// everything.
class HashLog {
 public:
  /// `every` [s]; a row at the start of a fresh run, none where a resumed one begins.
  HashLog(const session::Session& session, std::string path, double every);
  /// Called after each step: appends the row that is due. @throws FileError.
  /// At most one row a step.
  void observe();
  /// The state the run ends with. @throws FileError.
  void finish();

 private:
  void row();

  const session::Session& session_;
  RowFile file_;
  double every_;
  std::uint64_t next_ = 0;       ///< counts distances
  std::uint64_t last_step_ = 0;  ///< of the last row, no row = none written
};

}  // namespace navvy::record
