// SPDX-License-Identifier: Apache-2.0
#include "planner/ros/streams.h"

#include <algorithm>
#include <cmath>

namespace navvy::planner::ros {
namespace {

BodyState body_of(const sim::MachineHandle& machine, int link) {
  const sim::LinkHandle handle = machine.link(link);
  const vehicle::LinkState state = handle.state();
  return {machine.name() + "/" + handle.name(), state.X_WL, state.v_WL, state.w_WL};
}

/// Names of topics have letters, digits and underscores.
std::string topic_part(const std::string& name) {
  std::string out = name;
  for (char& c : out)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
  return out.empty() || (out[0] >= '0' && out[0] <= '9') ? "_" + out : out;
}

}  // namespace

std::int64_t stamp(double time) {
  return time == time ? static_cast<std::int64_t>(std::llround(time * 1e9)) : 0;
}

void write_clock(Bag& bag, std::int64_t time_ns) {
  bag.write("/clock", Kind::kClock, time_ns, clock(time_ns));
}

void write_map(Bag& bag, const TerrainMap& map, const std::vector<Layer>& layers,
               std::int64_t time_ns) {
  bag.write("/terrain/grid_map", Kind::kGridMap, time_ns, grid_map(map, layers, time_ns));
  bag.write("/terrain/points", Kind::kPointCloud, time_ns, point_cloud(map, layers, time_ns));
  if (std::find(layers.begin(), layers.end(), Layer::kTraversability) != layers.end())
    bag.write("/terrain/occupancy", Kind::kOccupancyGrid, time_ns, occupancy_grid(map, time_ns));
}

void write_machines(Bag& bag, const sim::World& world, std::int64_t time_ns) {
  std::vector<BodyState> bodies;
  for (int m = 0; m < world.machine_count(); ++m) {
    const sim::MachineHandle machine = world.machine(m);
    const std::string name = "/" + topic_part(machine.name());
    for (int i = 0; i < static_cast<int>(machine.description().links.size()); ++i)
      bodies.push_back(body_of(machine, i));
    JointStates joints;
    for (int i = 0; i < static_cast<int>(machine.description().joints.size()); ++i) {
      const sim::JointHandle joint = machine.joint(i);
      joints.names.push_back(joint.name());
      joints.positions.push_back(joint.position());
      joints.velocities.push_back(joint.velocity());
      joints.efforts.push_back(joint.effort());
    }
    bag.write(name + "/odom", Kind::kOdometry, time_ns, odometry(body_of(machine, 0), time_ns));
    bag.write(name + "/joint_states", Kind::kJointState, time_ns, joint_state(joints, time_ns));
  }
  if (!bodies.empty()) bag.write("/tf", Kind::kTf, time_ns, tf(bodies, time_ns));
}

}  // namespace navvy::planner::ros
