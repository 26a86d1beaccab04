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

/// Returns `name` as a valid part of a topic name: characters other than ASCII letters and digits
/// become underscores, and an underscore precedes a leading digit.
std::string topic_part(const std::string& name);

/// State of one machine.
struct MachineState {
  /// Name of the machine.
  std::string name;
  /// Transforms of the machine that change with time.
  std::vector<Transform> transforms;
  /// Pose and velocity of the machine's base as its odometry estimates them.
  BodyState odometry;
  /// True pose and velocity of the machine's base in the world frame.
  BodyState truth;
  /// States of the machine's joints.
  JointStates joints;
};

/// Appends the states of all machines: their transforms to /tf, and of each machine its odometry to
/// /<machine>/odom, its true state to /<machine>/ground_truth and its joints to
/// /<machine>/joint_states. `time_ns` is the simulated time [ns].
void write_machines(Bag& bag, const std::vector<MachineState>& machines, std::int64_t time_ns);

/// Appends transforms that never change to the topic /tf_static, as one latched message. Must be
/// called at most once for a bag. `time_ns` is the simulated time [ns].
void write_fixed(Bag& bag, const std::vector<Transform>& transforms, std::int64_t time_ns);

/// Appends the URDF text `urdf` of a machine to the topic /<machine>/robot_description, as a
/// latched message. Must be called at most once for a machine and bag. `time_ns` is the simulated
/// time [ns].
void write_description(Bag& bag, const std::string& machine, const std::string& urdf,
                       std::int64_t time_ns);

}  // namespace navvy::formats::ros
