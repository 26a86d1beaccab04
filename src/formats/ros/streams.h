// SPDX-License-Identifier: Apache-2.0
// The topics that a ROS bag contains for a map and for a running simulation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/ros/bag.h"

namespace navvy::formats::ros {

/// Converts a simulated time in seconds to a ROS time in nanoseconds. Returns 0 if `time` is NaN,
/// which means unknown.
std::int64_t stamp(double time);

/// Appends a message with the simulated time `time_ns` [ns] to the topic /clock.
void write_clock(Bag& bag, std::int64_t time_ns);

/// Appends `map` to the topics /terrain/grid_map and /terrain/points, and to /terrain/occupancy if
/// `layers` contains traversability. `time_ns` is the simulated time [ns].
void write_map(Bag& bag, const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns);

/// State of one machine.
struct MachineState {
  /// Name of the machine.
  std::string name;
  /// States of the machine's links, base link first. Their frames are called "<machine>/<link>".
  std::vector<BodyState> links;
  /// States of the machine's joints.
  JointStates joints;
};

/// Returns `name` as a valid part of a topic name: characters other than ASCII letters and digits
/// become underscores, and an underscore precedes a leading digit.
std::string topic_part(const std::string& name);

/// Appends the states of all machines: every link to /tf as a child of "map", the base link of each
/// machine to /<machine>/odom, and its joints to /<machine>/joint_states. `time_ns` is the
/// simulated time [ns].
void write_machines(Bag& bag, const std::vector<MachineState>& machines, std::int64_t time_ns);

}  // namespace navvy::formats::ros
