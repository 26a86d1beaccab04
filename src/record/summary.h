// SPDX-License-Identifier: Apache-2.0
// summary.json: what a run came to. Its keys are an interface, documented in
// docs/reference/results.md.
#pragma once

#include <string>
#include <vector>

#include "record/earthwork.h"
#include "session/session.h"

namespace navvy::record {

/// Version of the keys. It grows when a key changes its meaning.
inline constexpr int kSummarySchemaVersion = 1;

/// Status of a run, as the summary reports it.
struct RunStatus {
  /// "running", "finished" (every program is done), "incomplete" (a program is not), "interrupted"
  /// or "failed".
  std::string status = "running";
  /// Cause of a failure or an interruption.
  std::string message;
  /// Simulated time at the start of the process: above 0 for a resumed run [s].
  double start_time = 0;
  /// Wall times of simulating, drawing and writing [s]. They do not overlap.
  double wall_time = 0, render_time = 0, record_time = 0;
  /// Number of pictures written.
  int frames = 0;
};

/// Returns the minimum wall time between two rewrites of a summary of this size [s]. It limits the
/// output of a long run to 5 kB/s.
inline double rewrite_period(std::size_t bytes) { return static_cast<double>(bytes) / 5000; }

/// Returns the text of summary.json: SI units, which are part of the names, and sorted keys. If the
/// scene has a design, the ground is compared with it. The hash costs a pass over the whole state;
/// without it `state_hash` is null.
std::string summary_json(const session::Session& session, const RunStatus& status,
                         bool with_hash = true);

}  // namespace navvy::record
