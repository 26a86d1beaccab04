// SPDX-License-Identifier: Apache-2.0
// The part of the compact step that presses the ground with the bucket. Private to compact.
#pragma once

#include <memory>

#include "control/activities/compact.h"
#include "control/activity.h"
#include "control/reach.h"

namespace navvy::control {

/// Returns an activity that presses the bucket on the ground inside the step's polygon, from where
/// the machine stands. Places that it cannot press are left out, with a warning.
std::unique_ptr<Activity> bucket_press(OperatorContext& place, const Compact& step);

/// Reports the places of the step that the bucket does not reach. Warns of soils that only wheels
/// can make denser.
void check_bucket_press(const Compact& step, ReachCheck& check);

}  // namespace navvy::control
