// SPDX-License-Identifier: Apache-2.0
// The topics of a bag of a map, and of a running world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/ros/bag.h"

namespace navvy::formats::ros {

/// Returns simulated time [s] as ROS counts it [ns]; 0 where the time is unknown.
std::int64_t stamp(double time);

/// Appends /clock.
void write_clock(Bag& bag, std::int64_t time_ns);

/// Appends /terrain/grid_map, /terrain/points, and /terrain/occupancy where the layers include
/// traversability.
void write_map(Bag& bag, const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns);

/// The state of one machine.
struct MachineState {
  /// Name of the machine.
  std::string name;
  /// Its links, the base first; frames are called "<machine>/<link>".
  std::vector<BodyState> links;
  /// State of its joints.
  JointStates joints;
};

/// Returns a name in which every character that topics may not have is an underscore.
std::string topic_part(const std::string& name);

/// Appends /tf (every link in the frame "map"), and for each machine /<machine>/odom (its base
/// link) and /<machine>/joint_states.
void write_machines(Bag& bag, const std::vector<MachineState>& machines, std::int64_t time_ns);

}  // namespace navvy::formats::ros
