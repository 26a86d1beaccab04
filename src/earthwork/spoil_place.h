// SPDX-License-Identifier: Apache-2.0
// Places of a job's spoil. Private to earthwork.
#pragma once

#include <optional>
#include <vector>

#include "control/arm_kinematics.h"
#include "control/job_planner.h"
#include "control/surface.h"
#include "earthwork/pit_shape.h"

namespace navvy::earthwork {

/// Distance of spoil from the edge of the pit, at least [m].
inline constexpr double kSpoilClear = 0.5;

/// Returns true if the arm with its swing axis at X_WS can dump at the point `p`, on ground of the
/// given height in W [m].
bool can_dump(const control::PitJob& job, const control::ArmKinematics& arm, const Pose& X_WS,
              const Vec2& p, double height);

/// Returns the points of a job's windrow, half a metre apart; the one point of a heap.
std::vector<Vec2> spoil_points(const control::PitJob& job);

/// Returns those of these points at which the arm can dump with the swing axis at X_WS.
std::vector<Vec2> reachable_spoil(const control::PitJob& job, const control::ArmKinematics& arm,
                                  const Pose& X_WS, const control::SurfaceView& surface);

/// Returns the point of the windrow at which the spoil is lowest among those over which the bucket
/// can open with the swing axis at X_WS; if there is none, one beside the windrow, as near to it as
/// possible and clear of `pit`; nothing without one.
std::optional<Vec2> spoil_place(const control::PitJob& job, const control::ArmKinematics& arm,
                                const Pose& X_WS, const control::SurfaceView& surface,
                                const PitShape& pit);

}  // namespace navvy::earthwork
