// SPDX-License-Identifier: Apache-2.0
// Checks whether the programs of a scene can be carried out. A session does so before it starts,
// and so does `navvy check`.
#pragma once

#include <vector>

#include "control/path_planner.h"
#include "control/surface.h"
#include "core/error.h"
#include "core/math.h"
#include "scene/scene.h"

namespace navvy::session {

/// Returns an error for every target of a program that is out of reach, and a warning for every dig
/// that dumps too low over the bed of another machine. Each states file and line. Errors are
/// returned, not thrown.
///
/// `X_WB` contains the pose of each machine's base link in W, in the order of the machines in the
/// scene. `surface` gives the ground heights in W [m] to which digs and drives refer. `planners`
/// makes path planners for steps that plan paths.
std::vector<Fault> check_programs(const scene::Scene& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB,
                                  const control::MakePathPlanner& planners = {});

/// Checks the programs of a scene without running it: generates the initial ground or reads it from
/// the scene's map, places the machines on it, and calls the function above. Errors found while
/// making the ground are returned as well. Needs no OpenCL device.
std::vector<Fault> check_programs(const scene::Scene& world,
                                  const control::MakePathPlanner& planners = {});

}  // namespace navvy::session
