// SPDX-License-Identifier: Apache-2.0
// Job planner for pits (control/job_planner.h): stations by retreat along an axis, cuts in fans.
#pragma once

#include "control/job_planner.h"

namespace navvy::earthwork {

/// Returns a function that makes a job planner for a machine with an arm.
///
/// The machine works backwards: it stands on the line through the middle of the pit, digs what is
/// ahead of it, and backs. A pit wider than a lane is dug lane by lane. Ahead of the machine a face
/// is left at the angle of the batter, which the next station takes. At a station all cuts are
/// radial strips one bucket wide, because the arm works in planes through the swing axis; they are
/// planned for the whole fan of directions, layer by layer.
///
/// A plan takes some milliseconds per candidate axis, a list of cuts about a millisecond.
control::MakeJobPlanner job_planners();

}  // namespace navvy::earthwork
