// SPDX-License-Identifier: Apache-2.0
// Messages of ROS 2 as CDR bytes, for bags that planners play without Navvy. Only this folder uses
// Fast-CDR and SQLite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::formats::ros {

/// A message in a bag: encapsulation header, then little-endian CDR.
using Bytes = std::vector<char>;

/// Kinds of messages that are written here.
enum class MessageKind {
  kGridMap,
  kOccupancyGrid,
  kPointCloud,
  kOdometry,
  kJointState,
  kTf,
  kClock,
  kString,
  kUint8Array,
  kUint16Array,
  kInt32Array,
  kFloat32Array,
  kFloat64Array
};
/// Number of kinds.
inline constexpr int kMessageKinds = static_cast<int>(MessageKind::kFloat64Array) + 1;
/// Returns the ROS type, such as "grid_map_msgs/msg/GridMap".
const std::string& type_name(MessageKind kind);
/// Returns the definition of the message with all types it contains, as the schema encoding
/// `ros2msg` of MCAP requires.
const std::string& definition(MessageKind kind);

/// Name of frame W in messages.
inline constexpr const char* kFrame = "map";

/// Returns a GridMap. Its pose is the centre of the map; the numbers of a layer begin at greatest x
/// and greatest y and run first towards least x. `elevation` is the basic layer when it is among
/// the layers. Here and below, times are simulated ones from the start of the run [ns], lengths in
/// metres, angles in radians.
Bytes grid_map(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns);
/// Returns an OccupancyGrid: 100 (1 - traversability) rounded, -1 where unknown, row-major from the
/// lower-left column. The map must hold traversability.
Bytes occupancy_grid(const map::TerrainMap& map, std::int64_t time_ns);
/// Returns a PointCloud2 with a point (x y z in W as float32) for each column of known elevation,
/// row by row from least y, and a float32 field for each other layer.
Bytes point_cloud(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                  std::int64_t time_ns);

/// State of a body in W.
struct BodyState {
  /// Name of its frame, such as "excavator/chassis".
  std::string frame;
  /// Pose in W [m].
  Pose X_WB = Pose::Identity();
  /// Velocity of its origin in the axes of W [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Angular velocity in the axes of W [rad/s].
  Vec3 w_W = Vec3::Zero();
};
/// Returns an Odometry: pose in W, twist in the axes of the body. The covariances are 0, because
/// the state is exact.
Bytes odometry(const BodyState& body, std::int64_t time_ns);

/// State of the joints of a machine, in equal order.
struct JointStates {
  /// Names of the joints.
  std::vector<std::string> names;
  /// Positions [rad|m].
  std::vector<double> positions;
  /// Velocities [rad/s|m/s].
  std::vector<double> velocities;
  /// Efforts [N m|N].
  std::vector<double> efforts;
};
/// Returns a JointState.
Bytes joint_state(const JointStates& joints, std::int64_t time_ns);
/// Returns a TFMessage with every body as a child of W.
Bytes tf(const std::vector<BodyState>& bodies, std::int64_t time_ns);
/// Returns a Clock.
Bytes clock(std::int64_t time_ns);
/// Returns a String.
Bytes string_message(const std::string& text);
/// Returns a MultiArray of `shape` (row-major, slowest first). Its elements have `element_bytes`
/// bytes each, in the byte order of this machine, without padding.
Bytes multi_array(const std::vector<int>& shape, std::size_t element_bytes,
                  std::span<const std::byte> data);

}  // namespace navvy::formats::ros
