// SPDX-License-Identifier: Apache-2.0
// summary.json: what a run came to. Its keys are an interface, documented in scenarios/README.md.
#pragma once

#include <string>
#include <vector>

#include "record/earthwork.h"
#include "session/session.h"

namespace navvy::record {

inline constexpr int kSummarySchemaVersion = 1;

/// How the run stands: "running", "finished" (every program is done), "incomplete" (it ended, and a
/// program did not), "interrupted" or "failed".
struct RunStatus {
  std::string status = "running";
  std::string message;     ///< cause of a failure
  double start_time = 0;   ///< simulated time at which the run began: not 0 when it was resumed [s]
  double wall_time = 0;    ///< [s], without rendering
  double render_time = 0;  ///< [s]
  double record_time = 0;  ///< [s]
  int frames = 0;
};

/// Wall time that passes at least between rewrites of a summary of so many bytes [s]: over a day it
/// writes 5 kB a second at most, however many cycles it lists.
inline double rewrite_period(std::size_t bytes) { return static_cast<double>(bytes) / 5000; }

/// The file's text: JSON, keys sorted, SI units in the names. Where the scene has a design the
/// ground is held against it. The hash costs a pass over the whole state; without it `state_hash`
/// is null.
std::string summary_json(const session::Session& session, const RunStatus& status,
                         bool with_hash = true);

}  // namespace navvy::record
