// SPDX-License-Identifier: Apache-2.0
// summary.json: the results of a run in one file. Other programs rely on its keys, which
// docs/reference/results.md documents.
#pragma once

#include <string>
#include <vector>

#include "record/earthwork.h"
#include "session/session.h"

namespace navvy::record {

/// Version of the keys in summary.json. It increases when a key changes its meaning.
inline constexpr int kSummarySchemaVersion = 1;

/// Status of a run, as its summary reports it.
struct RunStatus {
  /// "running", "finished" (all programs have ended), "incomplete" (the run has ended, but a
  /// program has not), "interrupted" or "failed".
  std::string status = "running";
  /// Cause of a failure or an interruption; otherwise empty.
  std::string message;
  /// Simulated time at which this process started [s]; above 0 for a run that was resumed from a
  /// snapshot.
  double start_time = 0;
  /// Wall times spent on simulating, drawing pictures and writing results [s]. They do not overlap.
  double wall_time = 0, render_time = 0, record_time = 0;
  /// Processor time spent on encoding pictures [s], beside the simulation: not part of the above.
  double encode_time = 0;
  /// Number of pictures drawn so far.
  int frames = 0;
};

/// Returns the minimum wall time between two updates of a summary file of `bytes` bytes [s]. It
/// limits the output of a long run to 5 kB/s.
inline double rewrite_period(std::size_t bytes) { return static_cast<double>(bytes) / 5000; }

/// Returns the text of summary.json with sorted keys. Values are in SI units, and the name of a key
/// ends in the unit, as in "wall_time_s". If the scene has a design, the summary compares the
/// ground with it. The hash of the state costs a pass over the whole state; if `with_hash` is
/// false, `state_hash` is null.
std::string summary_json(const session::Session& session, const RunStatus& status,
                         bool with_hash = true);

}  // namespace navvy::record
