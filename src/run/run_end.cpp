// SPDX-License-Identifier: Apache-2.0
#include "run/run_end.h"

namespace navvy::run {

const char* name_of(EndReason reason) {
  switch (reason) {
    case EndReason::kComplete:
      return "complete";
    case EndReason::kFellShort:
      return "fell_short";
    case EndReason::kOutOfTime:
      return "out_of_time";
    case EndReason::kEndRequested:
      return "end_requested";
    case EndReason::kForbidden:
      return "forbidden";
    case EndReason::kMissedGoal:
      return "missed_goal";
    case EndReason::kInterrupted:
      break;
  }
  return "interrupted";
}

// The summary knows four ends; its readers find the details in its list of programs.
const char* status_of(EndReason reason) {
  if (reason == EndReason::kInterrupted) return "interrupted";
  if (reason == EndReason::kForbidden) return "failed";
  return reason == EndReason::kComplete ? "finished" : "incomplete";
}

}  // namespace navvy::run
