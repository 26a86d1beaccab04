// SPDX-License-Identifier: Apache-2.0
// The sensors of a world as streams of a ROS bag.
#pragma once

#include <vector>

#include "record/sensor_topics.h"
#include "sim/world.h"

namespace navvy::record {

/// Returns a stream for each sensor of `world`, in the order of the scene. Lidars with one level
/// ring are scans; other lidars and time-of-flight cameras are clouds. Sensors of cylinders,
/// contacts, tools and payloads have no message of sensor_msgs: their arrays are written by
/// themselves.
std::vector<SensorStream> sensor_streams(const sim::World& world);

}  // namespace navvy::record
