// SPDX-License-Identifier: Apache-2.0
// Checks that the bucket can be opened over a dump point. Private to the dig.
#pragma once

#include <string>

#include "control/activity_step.h"
#include "control/arm_kinematics.h"
#include "control/reach.h"

namespace navvy::control {

/// Suggestion for a target in a direction to which the swing cannot turn.
inline constexpr const char* kMoveOrTurn = "move the target or turn the machine";

/// Reports an error if the arm cannot open a level bucket over the dump point of the step being
/// checked. `step` is the step's element; X_WS is the pose of the swing axis frame in W.
void require_dump(ReachCheck& check, const ArmKinematics& arm, const Pose& X_WS,
                  const std::string& step, const DumpPoint& dump);

}  // namespace navvy::control
