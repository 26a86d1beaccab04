// SPDX-License-Identifier: Apache-2.0
// Which topics a bag of a map, and of a running world, has.
#pragma once

#include "planner/ros/bag.h"
#include "sim/world.h"

namespace navvy::planner::ros {

/// Simulated time as ROS counts it; 0 where the time is unknown [ns].
std::int64_t stamp(double time);

/// /clock.
void write_clock(Bag& bag, std::int64_t time_ns);

/// /terrain/grid_map, /terrain/points, and /terrain/occupancy where the layers have traversability.
void write_map(Bag& bag, const TerrainMap& map, const std::vector<Layer>& layers,
               std::int64_t time_ns);

/// /tf (every link, "<machine>/<link>", in the frame "map"), and of each machine /<machine>/odom
/// (its base link) and /<machine>/joint_states.
void write_machines(Bag& bag, const sim::World& world, std::int64_t time_ns);

}  // namespace navvy::planner::ros
