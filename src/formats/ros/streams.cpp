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
  std::vector<BodyState> bodies;
  for (const MachineState& machine : machines) {
    const std::string name = "/" + topic_part(machine.name);
    bodies.insert(bodies.end(), machine.links.begin(), machine.links.end());
    bag.write(name + "/odom", MessageKind::kOdometry, time_ns,
              odometry(machine.links.at(0), time_ns));
    bag.write(name + "/joint_states", MessageKind::kJointState, time_ns,
              joint_state(machine.joints, time_ns));
  }
  if (!bodies.empty()) bag.write("/tf", MessageKind::kTf, time_ns, tf(bodies, time_ns));
}

}  // namespace navvy::formats::ros
