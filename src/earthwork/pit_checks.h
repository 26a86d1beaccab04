// SPDX-License-Identifier: Apache-2.0
// Faults of a pit that show before a run. Private to earthwork.
#pragma once

#include <vector>

#include "control/arm_kinematics.h"
#include "control/job_planner.h"
#include "earthwork/pit_shape.h"
#include "earthwork/station_search.h"

namespace navvy::earthwork {

/// Returns the pose of a base link in W that stands at `at`, `rise` [m] above the ground.
Pose station_pose(const control::PlanePose& at, double rise, const control::SurfaceView& surface);

/// Returns the height up to which soil of these constants stands at the angle `batter` [rad] by
/// the wedge of Culmann [m]; infinity up to its angle of internal friction.
double standing_height(const scene::Soil& soil, double batter);

/// Returns faults of the shape of a pit and of its spoil: sides that the soil does not stand at,
/// and spoil that would fall into the pit.
std::vector<control::JobFault> check_pit(const control::PitJob& job, const PitShape& pit,
                                         const control::SurfaceView& surface);

/// The arm of a machine, and the height of its base link above the ground [m].
struct StandingArm {
  const control::ArmKinematics& arm;
  double rise = 0;
};
/// Appends a fault for each station at which the machine would stand at the border of the site.
void check_on_site(const std::vector<control::JobStation>& stations,
                   const control::SurfaceView& surface, std::vector<control::JobFault>& faults);
/// Appends faults of stations: soil that none reaches, stations off the site or on the spoil,
/// and spoil out of reach.
void check_stations(const control::PitJob& job, const Stations& found, const StandingArm& machine,
                    const control::SurfaceView& surface, std::vector<control::JobFault>& faults);

}  // namespace navvy::earthwork
