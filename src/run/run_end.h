// SPDX-License-Identifier: Apache-2.0
// Why a run ended.
#pragma once

#include <string>

namespace navvy::run {

/// Reason of an end. The first one that holds counts: interrupted, complete, fell short, and only
/// then a request or the duration.
enum class EndReason {
  kComplete,      ///< every program reached its end and no machine fell over
  kFellShort,     ///< a step of a program failed, or a machine fell over
  kOutOfTime,     ///< the duration was over before the programs were
  kEndRequested,  ///< the caller or its controller ended the run before its end
  kInterrupted    ///< a signal, or a controller that went away
};

/// End of a run.
struct RunEnd {
  EndReason reason = EndReason::kEndRequested;
  std::string cause;             ///< of an interruption, for people
  double time = 0;               ///< simulated [s]
  bool snapshot_missed = false;  ///< the run ended before SimulationOptions::snapshot_at
};

/// Returns the reason in words: "complete", "fell_short", "out_of_time", "end_requested" or
/// "interrupted".
const char* name_of(EndReason reason);
/// Returns the status that summary.json gives a run with this end.
const char* status_of(EndReason reason);

}  // namespace navvy::run
