// SPDX-License-Identifier: Apache-2.0
// Turns of crawlers on the spot, as part of a planned drive.
#pragma once

#include <optional>

#include "control/path_planner.h"
#include "control/pursuit.h"
#include "vehicle/drive/drive_input.h"

namespace navvy::control {

/// Returns true if a machine turns on the spot: it runs on tracks, which it drives separately.
bool turns_in_place(const scene::Machine& machine);

/// Returns true if a machine that turns on the spot from the pose `at` to the heading `yaw` [rad],
/// the shorter way, keeps `clearance` [m], or the clearance that it has at `at` if that is less.
bool can_turn(const PathPlanner& planner, const PlanePose& at, double yaw, double clearance);

/// Returns a path for `query`; nothing if there is none. Where the planner's path changes its
/// direction, or there is none, a machine that turns on the spot gets a straight path, if it has
/// space to turn at both ends: its start has another heading than that of the query, and so may its
/// end. Of forwards and backwards it is the one with the smaller turns.
std::optional<Path> plan_path(const PathPlanner& planner, const scene::Machine& machine,
                              const PathQuery& query);

/// Returns the command that turns a machine on the spot by the angle `left` [rad], positive to the
/// left.
vehicle::DriveInput turn_command(double left);

/// Returns the time after which a turn by an angle [rad] is given up [s].
double longest_turn(double angle);

}  // namespace navvy::control
