// SPDX-License-Identifier: Apache-2.0
#include "control/activity_step.h"

#include "core/error.h"

namespace navvy::control {

const ActivityStep& step_of(const scene::ProgramStep& step) {
  // Scenes may come from anywhere; only here is a step known to have an activity.
  const auto* known = step.as<ActivityStep>();
  if (known == nullptr)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "navvy:program", step->element(),
                           "no operator can carry out this step", "derive it from control::Step"});
  return *known;
}

}  // namespace navvy::control
