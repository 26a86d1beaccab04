// SPDX-License-Identifier: Apache-2.0
// Heaps and windrows from which soil is taken, and jobs that load trucks from them. Private to
// earthwork.
#pragma once

#include <vector>

#include "control/job_planner.h"
#include "control/surface.h"
#include "earthwork/arm_reach.h"
#include "earthwork/pit_shape.h"

namespace navvy::earthwork {

/// Part of a heap that is left, to spare the ground below [m].
inline constexpr double kHeapSkin = 0.05;

/// Returns the shape of the soil that is taken from a heap.
PitShape heap_shape(const control::JobHeap& heap, const control::SurfaceView& surface);
/// Returns the volume of the present soil of a heap [m3].
double heap_volume(const PitShape& heap);
/// Returns the ends of the heap's strip and places in between.
std::vector<Vec2> heap_points(const control::JobHeap& heap);
/// Returns true if a machine with its swing axis at `centre` in W and the heading `yaw` [rad]
/// reaches one of the points, `most` [m] away at most.
bool reaches_heap(const std::vector<Vec2>& points, const Vec2& centre, double yaw, double most);
/// Returns the cuts of a heap from the pose X_WB of the base link, as cut_fan.
std::vector<control::JobCut> heap_cuts(const control::PitJob& job, const PitShape& heap,
                                       const ArmReach& reach, const Pose& X_WB,
                                       const control::SurfaceView& surface);

/// Returns the plan of a job that loads trucks from a heap, from where the machine stands.
control::JobPlan plan_loading(const control::PitJob& job, const ArmReach& reach, const Pose& X_WB,
                              const control::SurfaceView& surface);
/// Returns the volume of the heap, of which all is left.
control::JobVolume loading_volume(const control::PitJob& job, const control::SurfaceView& surface);

}  // namespace navvy::earthwork
