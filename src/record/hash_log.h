// SPDX-License-Identifier: Apache-2.0
// hashes.csv: hashes of all parts of the state, at fixed intervals of simulated time.
#pragma once

#include <cstdint>
#include <string>

#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// Writes a row per interval: step, time [s], the hash of the whole state, then those of its parts.
/// A comparison of two files line by line shows when two runs diverged, and which part diverged
/// first. Each row costs a pass over the whole state.
class HashLog {
 public:
  /// Begins the file; `every` is the interval [s]. A new run has a row at its start, a resumed run
  /// continues with the next interval.
  HashLog(const session::Session& session, std::string path, double every);
  /// Appends a row if one is due, at most one per step. Call it after each step. @throws FileError.
  void observe();
  /// Appends a row for the final state and waits for the disk. @throws FileError.
  void finish();

 private:
  /// Appends a row for the present state.
  void row();

  const session::Session& session_;
  RowFile file_;
  double every_;                 ///< interval [s]
  std::uint64_t next_ = 0;       ///< number of the next interval
  std::uint64_t last_step_ = 0;  ///< step of the last row
};

}  // namespace navvy::record
