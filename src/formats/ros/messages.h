// SPDX-License-Identifier: Apache-2.0
// ROS 2 messages encoded as CDR bytes, for bags that can be played without Navvy. Only this folder
// uses Fast-CDR and SQLite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::formats::ros {

/// An encoded message: encapsulation header, followed by the little-endian CDR data.
using Bytes = std::vector<char>;

/// Types of messages that the functions of this header encode.
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
  kFloat64Array,
  kLaserScan,
  kRange,
  kImu,
  kNavSatFix,
  kImage,
  kCameraInfo
};
/// Number of message types.
inline constexpr int kMessageKinds = static_cast<int>(MessageKind::kCameraInfo) + 1;
/// Returns the ROS name of a message type, such as "grid_map_msgs/msg/GridMap".
const std::string& type_name(MessageKind kind);
/// Returns the definition of a message type and of all types that it contains, in MCAP's schema
/// encoding `ros2msg`.
const std::string& definition(MessageKind kind);

/// Name of the world frame W in messages.
inline constexpr const char* kFrame = "map";

/// Returns a GridMap message with `layers` of `map`, stamped with the simulated time `time_ns`
/// [ns]. Its pose is the centre of the map. The values of a layer begin at the largest x and y; x
/// changes fastest and decreases. `elevation` is the basic layer if it is one of the layers.
Bytes grid_map(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns);
/// Returns an OccupancyGrid message, stamped with the simulated time `time_ns` [ns]. Its values are
/// 100 (1 - traversability), rounded, and -1 where the traversability is unknown; row-major,
/// beginning at the smallest x and y. The map must contain the layer traversability.
Bytes occupancy_grid(const map::TerrainMap& map, std::int64_t time_ns);
/// Returns a PointCloud2 message, stamped with the simulated time `time_ns` [ns]. It has one point
/// for each column of known elevation, row by row from the smallest y: world x, y, z as float32
/// [m], and a float32 field for each other layer.
Bytes point_cloud(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                  std::int64_t time_ns);

/// Pose and velocity of a body B relative to a parent frame P.
struct BodyState {
  /// Name of the parent frame, such as "excavator/odom".
  std::string parent = kFrame;
  /// Name of the body's frame, such as "excavator/base_link".
  std::string frame;
  /// Pose of the body frame in the parent frame [m].
  Pose X_PB = Pose::Identity();
  /// Velocity of the origin of the body frame, in the axes of the body frame [m/s].
  Vec3 v_B = Vec3::Zero();
  /// Angular velocity of the body, in the axes of the body frame [rad/s].
  Vec3 w_B = Vec3::Zero();
};
/// Returns an Odometry message with the pose of the body in its parent frame and its twist in the
/// axes of the body, stamped with the simulated time `time_ns` [ns]. The covariances are 0, which
/// means that none is stated.
Bytes odometry(const BodyState& body, std::int64_t time_ns);

/// State of the joints of a machine. All vectors have one entry per joint, in the same order.
struct JointStates {
  /// Names of the joints, those of the machine's file.
  std::vector<std::string> names;
  /// Positions of the joints [rad|m].
  std::vector<double> positions;
  /// Velocities of the joints [rad/s|m/s].
  std::vector<double> velocities;
  /// Torques or forces of the joints [N m|N].
  std::vector<double> efforts;
};
/// Returns a JointState message, stamped with the simulated time `time_ns` [ns].
Bytes joint_state(const JointStates& joints, std::int64_t time_ns);
/// Pose of a frame C relative to its parent frame P.
struct Transform {
  /// Names of the two frames, without a slash at the start.
  std::string parent, child;
  /// Pose of the child in the parent [m].
  Pose X_PC = Pose::Identity();
};
/// Returns a TFMessage with all transforms, stamped with the simulated time `time_ns` [ns].
Bytes tf(const std::vector<Transform>& transforms, std::int64_t time_ns);
/// Returns a Clock message with the simulated time `time_ns` [ns].
Bytes clock(std::int64_t time_ns);
/// Returns a String message with `text`.
Bytes string_message(const std::string& text);
/// Returns a MultiArray message. `shape` contains the size of each dimension, slowest first. `data`
/// contains the elements in row-major order, `element_bytes` bytes each, in the byte order of this
/// machine and without padding.
Bytes multi_array(const std::vector<int>& shape, std::size_t element_bytes,
                  std::span<const std::byte> data);

}  // namespace navvy::formats::ros
