// SPDX-License-Identifier: Apache-2.0
// The machines of a running world as topics of a ROS bag: transforms, odometry, joints and URDF.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "control/odometry.h"
#include "formats/ros/machine_frames.h"
#include "formats/ros/streams.h"
#include "record/sensor_topics.h"
#include "sim/world.h"

namespace navvy::record {

/// Writes the machines of a world into a ROS bag.
///
/// The frames form the tree of REP 105 for each machine: "map", "<machine>/odom",
/// "<machine>/base_link", below it the links in the order of the joints. Frames that never move
/// relative to their parents go to /tf_static once, the others to /tf.
///
/// "odom" is the frame of the machine's own odometry. It coincides with "map" when the bag begins,
/// and drifts from then on for a machine with encoders on two wheels (control::wheel_odometry): the
/// transform from odom to base_link is the estimate from the registers of the encoders, level and
/// at the height of the start, and that from map to odom is the difference to the true pose. For
/// other machines, the estimate is the true pose, and odom always coincides with map.
class MachineTopics {
 public:
  /// Starts the odometry of all machines at their current poses. The frames of `sensors` become
  /// fixed children of their links. `world` must outlive this object.
  explicit MachineTopics(const sim::World& world, const std::vector<SensorStream>& sensors = {});

  /// Starts the odometry of all machines at their current poses. Must be called after the world was
  /// put into another state, and before the first message to a new bag.
  void restart();
  /// Reads the encoders. Must be called after each step, so that no register is missed.
  void observe();
  /// Appends the state of all machines to `bag`, after the fixed frames and the descriptions if the
  /// bag does not have them. `time_ns` is the simulated time [ns].
  /// @throws FileError if the bag cannot be written.
  void write(formats::ros::Bag& bag, std::int64_t time_ns);
  /// Returns true if the tree has a frame of this name, such as "excavator/boom".
  bool has_frame(const std::string& name) const { return frames_.count(name) > 0; }

 private:
  /// Odometry of a machine by its encoders.
  struct Counted {
    /// Estimate and the joints that it reads.
    control::WheelOdometry wheels;
    /// Height of the machine's frame when the odometry started [m].
    double z = 0;
    /// Distance [m], heading [rad] and simulated time [s] at the last message.
    double distance = 0, yaw = 0, time = 0;
  };
  /// A machine with its frames.
  struct Entry {
    sim::MachineHandle machine;
    std::vector<formats::ros::MachineFrame> frames;
    std::optional<Counted> odometry;
  };
  /// Starts the odometry of a machine at its current pose.
  void start(Entry& entry);
  /// Writes the fixed frames and the descriptions of all machines.
  void write_fixed(formats::ros::Bag& bag, std::int64_t time_ns) const;
  /// Returns the state of a machine and stores what the next call needs for its velocities.
  formats::ros::MachineState state_of(Entry& entry);
  /// Returns the estimated state of the frame "<machine>/base_link" in "<machine>/odom".
  formats::ros::BodyState estimate(Entry& entry) const;

  const sim::World& world_;
  /// Machines in the order of the scene.
  std::vector<Entry> machines_;
  /// Names of all frames of the tree.
  std::set<std::string> frames_;
};

}  // namespace navvy::record
