// SPDX-License-Identifier: Apache-2.0
// Checks that the programs of a scene can be carried out. A session asks before it starts, and so
// does `navvy check`.
#pragma once

#include <vector>

#include "control/path_planner.h"
#include "control/surface.h"
#include "core/error.h"
#include "core/math.h"
#include "scene/scene.h"

namespace navvy::session {

/// Returns an error for every target of a program that is out of reach, and a warning for every dig
/// that dumps too low over the bed of another machine. Faults name file and line.
///
/// `X_WB` holds the pose of each machine's base link in W, in the order of the scene. `surface`
/// gives the heights in W [m] that digs and drives refer to. `planners` makes path planners for
/// steps that need paths. Throws nothing of its own.
std::vector<Fault> check_programs(const scene::Scene& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB,
                                  const control::MakePathPlanner& planners = {});

/// Checks the programs of a scene that does not run: makes its ground (reads its map) and places
/// the machines on it. Faults of the ground are returned, too. Needs no OpenCL device.
std::vector<Fault> check_programs(const scene::Scene& world,
                                  const control::MakePathPlanner& planners = {});

}  // namespace navvy::session
