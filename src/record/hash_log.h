// SPDX-License-Identifier: Apache-2.0
// hashes.csv: a table of hashes of all parts of the state, at regular intervals of simulated time.
#pragma once

#include <cstdint>
#include <string>

#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// Writes the table hashes.csv, one row per interval: step number, time [s], the hash of the whole
/// state, and the hash of each part of the state. A line-by-line comparison of the tables of two
/// runs shows when the runs diverged and which part diverged first. Each row costs a pass over the
/// whole state.
class HashLog {
 public:
  /// Begins the table in the file `path`; `every` is the interval of simulated time [s]. A new run
  /// gets a row for its start; a resumed run gets its first row at the next multiple of the
  /// interval.
  HashLog(const session::Session& session, std::string path, double every);
  /// Appends a row if the simulated time has reached the next multiple of the table's interval
  /// since the last call. Must be called after each step.
  /// @throws FileError if the row cannot be written.
  void observe();
  /// Appends a row for the final state, unless it has one already, and waits until the file is
  /// stored on the disk.
  /// @throws FileError if the file cannot be written.
  void finish();
  /// Continues in a copy of the file at `path`.
  /// @throws FileError if the rows cannot be copied.
  void move_to(const std::string& path) { file_.move_to(path); }

 private:
  /// Appends a row with the hashes of the current state and writes it to the file.
  void row();

  const session::Session& session_;
  RowFile file_;
  /// Interval of simulated time [s].
  double every_;
  /// Index of the next interval: the next row is due at the simulated time next_ x every_.
  std::uint64_t next_ = 0;
  /// Step number of the last row.
  std::uint64_t last_step_ = 0;
};

}  // namespace navvy::record
