// SPDX-License-Identifier: Apache-2.0
// Faults of a plan as text, for tests of job planners.
#pragma once

#include <string>

#include "control/job_planner.h"

namespace navvy::earthwork {

/// Returns the text of all faults of a plan.
inline std::string text_of(const control::JobPlan& plan) {
  std::string out;
  for (const control::JobFault& one : plan.faults)
    out += one.part + ": " + one.value + ": " + one.rule + "; " + one.remedy + "\n";
  return out;
}

}  // namespace navvy::earthwork
