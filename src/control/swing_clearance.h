// SPDX-License-Identifier: Apache-2.0
// Height of the bucket above the ground during a move of the arm.
#pragma once

#include "control/arm_kinematics.h"
#include "control/arm_move.h"
#include "control/surface.h"

namespace navvy::control {

/// Returns the least height [m] of the bucket's lowest point above the surface under its tip and
/// beside it, by half the bucket's width, from the time `since` [s] of a move to its end. Negative
/// if the bucket would go through the ground. X_WS is the pose of the swing axis frame S in W.
double least_clearance(const ArmMove& move, double since, const ArmKinematics& arm,
                       const Pose& X_WS, const SurfaceView& surface);

}  // namespace navvy::control
