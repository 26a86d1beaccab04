// SPDX-License-Identifier: Apache-2.0
// Whether the programs of a scene can be carried out: asked by a session before it starts, and by
// `navvy check`.
#pragma once

#include <vector>

#include "control/path_planner.h"
#include "control/surface.h"
#include "core/error.h"
#include "core/math.h"
#include "scene/scene.h"

namespace navvy::session {

/// Every target of every program that is out of reach (errors) and every dig that dumps too low
/// over another machine's bed (warnings), with file and line. `X_WB` holds where the machines' base
/// links stand in the world, one pose a machine; `surface` [m in W] is what digs and drives look
/// at; `planners` is asked where a step needs paths. Throws nothing of its own.
std::vector<Fault> check_programs(const scene::Scene& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB,
                                  const control::MakePathPlanner& planners = {});

/// The same for a scene that does not run: lays its ground (reads its map) and puts the machines on
/// it. What is wrong with the ground is among the faults. Needs no device.
std::vector<Fault> check_programs(const scene::Scene& world,
                                  const control::MakePathPlanner& planners = {});

}  // namespace navvy::session
