// SPDX-License-Identifier: Apache-2.0
// Checks whether the programs of a scene can be carried out. A session does so before it starts,
// and so does `navvy check`.
#pragma once

#include <string>
#include <vector>

#include "control/planners.h"
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
/// makes the planners of steps that plan. Lines about plans, such as the stations of a job, are
/// appended to `notes`, which may be null.
std::vector<Fault> check_programs(const scene::Scene& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB,
                                  const control::Planners& planners = {},
                                  std::vector<std::string>* notes = nullptr);

/// Returns an error for every target of `program` that the machine with the index `machine` in the
/// scene cannot reach, for a step whose receiver is no other machine with a bed, that waits for no
/// other machine, or that opens no hitch of the machine. `X_WB` are the present poses of all base
/// links; `surface` and `planners` are as above. Messages name "order" as the file of `program`.
std::vector<Fault> check_program(const scene::Scene& world, std::size_t machine,
                                 const scene::Program& program, const control::SurfaceView& surface,
                                 const std::vector<Pose>& X_WB, const control::Planners& planners);

/// Checks the programs of a scene without running it: generates the initial ground or reads it from
/// the scene's map, places the machines on it, and calls the function above. Errors found while
/// making the ground are returned as well. Needs no OpenCL device.
std::vector<Fault> check_programs(const scene::Scene& world, const control::Planners& planners = {},
                                  std::vector<std::string>* notes = nullptr);

}  // namespace navvy::session
