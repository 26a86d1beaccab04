// SPDX-License-Identifier: Apache-2.0
// Height of the bucket above the ground during a move of the arm.
#pragma once

#include "control/arm_kinematics.h"
#include "control/arm_move.h"
#include "control/surface.h"

namespace navvy::control {

/// Least height of the bucket over ground that it passes on a swing [m].
inline constexpr double kOverHeap = 0.15;

/// Returns the least height [m] of the bucket's lowest point above the surface under its tip and
/// beside it, by half the bucket's width, from the time `since` [s] of a move to its end. Negative
/// if the bucket would go through the ground. X_WS is the pose of the swing axis frame S in W.
double least_clearance(const ArmMove& move, double since, const ArmKinematics& arm,
                       const Pose& X_WS, const SurfaceView& surface);

/// Returns the height in W [m] of the bucket's lowest point at a pose of the bucket.
double lowest_point(const BucketPose& pose, const ArmKinematics& arm, const Pose& X_WS);

/// A swing with a load to where the bucket opens.
struct CarrySwing {
  double from = 0, to = 0;       ///< angles of the swing joint [rad]
  Vec2 dump_at = Vec2::Zero();   ///< where the soil falls in W [m]
  Pose X_WS = Pose::Identity();  ///< pose of the swing axis frame S in W
};

/// Returns the height in W [m] of the highest ground under the bucket in the first `share` of a
/// swing; its reach is that of the place where it opens.
double highest_on_arc(const CarrySwing& swing, double share, const SurfaceView& surface);

/// Changes a swing on whose way the ground is too high for the bucket, which also comes back
/// opened: raises `q`, the angles of boom, stick and bucket at its end, or, where the arm cannot be
/// so high there, turns the other way round. Leaves a swing as it is if neither helps.
void pass_over(const ArmKinematics& arm, const SurfaceView& surface, CarrySwing& swing,
               ArmAngles& q);

}  // namespace navvy::control
