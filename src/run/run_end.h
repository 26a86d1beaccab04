// SPDX-License-Identifier: Apache-2.0
// How and why a run ended.
#pragma once

#include <string>

namespace navvy::run {

/// Reason why a run ended. If several reasons apply, the first one in this order is reported:
/// kInterrupted, kForbidden, kMissedGoal, kComplete, kFellShort, then one of the others.
enum class EndReason {
  /// All programs were completed, and no machine fell over.
  kComplete,
  /// A program step failed, or a machine fell over.
  kFellShort,
  /// The maximum simulated time was reached before the programs ended.
  kOutOfTime,
  /// The caller or a controller ended the run early.
  kEndRequested,
  /// A signal interrupted the run, or its controller disconnected.
  kInterrupted,
  /// An event occurred that the scene forbids.
  kForbidden,
  /// All programs were completed, but the run missed a goal of the scene.
  kMissedGoal
};

/// Result of a run.
struct RunEnd {
  /// Reason why the run ended.
  EndReason reason = EndReason::kEndRequested;
  /// Cause of an interruption, the forbidden event or the missed goals, as text for the user; empty
  /// for other reasons.
  std::string cause;
  /// Simulated time at the end [s].
  double time = 0;
  /// True if the run ended before SimulationOptions::snapshot_at, so that the requested snapshot
  /// was not written.
  bool snapshot_missed = false;
  /// Number of pictures that were recorded.
  int pictures = 0;
  /// Wall time of the run, wall time of drawing pictures, which is part of it, and processor time
  /// of encoding them, which ran beside the simulation [s]. 0 without a recording.
  double wall_time = 0, drawing_time = 0, encoding_time = 0;
};

/// Returns the name of an end reason: "complete", "fell_short", "out_of_time", "end_requested",
/// "interrupted", "forbidden" or "missed_goal".
const char* name_of(EndReason reason);
/// Returns the value of "status" in summary.json for a run with this end reason: "finished",
/// "incomplete", "interrupted" or "failed".
const char* status_of(EndReason reason);

}  // namespace navvy::run
