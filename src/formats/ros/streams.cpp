// SPDX-License-Identifier: Apache-2.0
#include "formats/ros/streams.h"

#include <algorithm>
#include <cmath>

namespace navvy::formats::ros {

// A topic may not begin with a digit either.
std::string topic_part(const std::string& name) {
  std::string out = name;
  for (char& c : out)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
  return out.empty() || (out[0] >= '0' && out[0] <= '9') ? "_" + out : out;
}

std::int64_t stamp(double time) {
  return time == time ? static_cast<std::int64_t>(std::llround(time * 1e9)) : 0;
}

void write_clock(Bag& bag, std::int64_t time_ns) {
  bag.write("/clock", MessageKind::kClock, time_ns, clock(time_ns));
}

void write_map(Bag& bag, const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns) {
  bag.write("/terrain/grid_map", MessageKind::kGridMap, time_ns, grid_map(map, layers, time_ns));
  bag.write("/terrain/points", MessageKind::kPointCloud, time_ns,
            point_cloud(map, layers, time_ns));
  if (std::find(layers.begin(), layers.end(), map::MapLayer::kTraversability) != layers.end())
    bag.write("/terrain/occupancy", MessageKind::kOccupancyGrid, time_ns,
              occupancy_grid(map, time_ns));
}

// One /tf message holds all machines, so that readers see them at one time.
void write_machines(Bag& bag, const std::vector<MachineState>& machines, std::int64_t time_ns) {
  std::vector<Transform> transforms;
  for (const MachineState& machine : machines) {
    const std::string name = "/" + topic_part(machine.name);
    transforms.insert(transforms.end(), machine.transforms.begin(), machine.transforms.end());
    bag.write(name + "/odom", MessageKind::kOdometry, time_ns, odometry(machine.odometry, time_ns));
    bag.write(name + "/ground_truth", MessageKind::kOdometry, time_ns,
              odometry(machine.truth, time_ns));
    bag.write(name + "/joint_states", MessageKind::kJointState, time_ns,
              joint_state(machine.joints, time_ns));
  }
  if (!transforms.empty()) bag.write("/tf", MessageKind::kTf, time_ns, tf(transforms, time_ns));
}

// One message alone: a player keeps only the last ones of a latched topic.
void write_fixed(Bag& bag, const std::vector<Transform>& transforms, std::int64_t time_ns) {
  bag.write_latched("/tf_static", MessageKind::kTf, time_ns, tf(transforms, time_ns));
}

void write_description(Bag& bag, const std::string& machine, const std::string& urdf,
                       std::int64_t time_ns) {
  bag.write_latched("/" + topic_part(machine) + "/robot_description", MessageKind::kString, time_ns,
                    string_message(urdf));
}

}  // namespace navvy::formats::ros
