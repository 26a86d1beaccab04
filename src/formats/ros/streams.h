// SPDX-License-Identifier: Apache-2.0
// The topics of a bag of a map, and of a running world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/ros/bag.h"

namespace navvy::formats::ros {

/// Simulated time as ROS counts it; 0 where the time is unknown [ns].
std::int64_t stamp(double time);

/// /clock.
void write_clock(Bag& bag, std::int64_t time_ns);

/// /terrain/grid_map, /terrain/points, and /terrain/occupancy where the layers have traversability.
void write_map(Bag& bag, const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns);

/// The state of one machine.
struct MachineState {
  /// Name of the machine.
  std::string name;
  /// Its links, the base first; frames are called "<machine>/<link>".
  std::vector<BodyState> links;
  JointStates joints;
};

/// Returns a name with every sign that names of topics do not have replaced by an underscore.
std::string topic_part(const std::string& name);

/// Appends /tf (every link in the frame "map"), and for each machine /<machine>/odom (its base
/// link) and /<machine>/joint_states.
void write_machines(Bag& bag, const std::vector<MachineState>& machines, std::int64_t time_ns);

}  // namespace navvy::formats::ros
