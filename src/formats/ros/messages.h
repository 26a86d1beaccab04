// SPDX-License-Identifier: Apache-2.0
// Messages of ROS 2 as CDR bytes, for bags that planners play without Navvy. The only folder with
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

/// A message as a bag holds it: encapsulation header, then little-endian CDR.
using Bytes = std::vector<char>;

/// The kinds that are written here.
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
inline constexpr int kMessageKinds = static_cast<int>(MessageKind::kFloat64Array) + 1;
/// "grid_map_msgs/msg/GridMap".
const std::string& type_name(MessageKind kind);
/// The message's definition with all that it is made of, as MCAP's schema encoding `ros2msg` wants
/// it.
const std::string& definition(MessageKind kind);

/// The frame that all of W is in.
inline constexpr const char* kFrame = "map";

// Times are simulated ones from the start of the run [ns]; lengths are in metres, angles in
// radians.

/// grid_map: pose is the map's centre; a layer's numbers begin at greatest x and greatest y and run
/// first towards least x. `elevation` is the basic layer where it is asked for.
Bytes grid_map(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns);
/// 100 (1 - traversability) rounded, -1 unknown; row-major from the lower-left column. The map must
/// have it.
Bytes occupancy_grid(const map::TerrainMap& map, std::int64_t time_ns);
/// A point (x y z as float32, relative to W) for each column whose elevation is known, row by row
/// from least y, and a float32 field for each other layer.
Bytes point_cloud(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                  std::int64_t time_ns);

/// A body in W.
struct BodyState {
  std::string frame;             ///< "excavator/chassis"
  Pose X_WB = Pose::Identity();  ///< [m]
  Vec3 v_W = Vec3::Zero();       ///< of its origin, axes of W [m/s]
  Vec3 w_W = Vec3::Zero();       ///< [rad/s]
};
/// Pose in W, twist in the body's own axes; covariances are 0: it is the truth.
Bytes odometry(const BodyState& body, std::int64_t time_ns);

struct JointStates {
  std::vector<std::string> names;
  std::vector<double> positions;   ///< [rad|m]
  std::vector<double> velocities;  ///< [rad/s|m/s]
  std::vector<double> efforts;     ///< [N m|N]
};
Bytes joint_state(const JointStates& joints, std::int64_t time_ns);
/// Every body as a child of W's frame.
Bytes tf(const std::vector<BodyState>& bodies, std::int64_t time_ns);
Bytes clock(std::int64_t time_ns);
/// A text.
Bytes string_message(const std::string& text);
/// A MultiArray of `shape` (row-major, slowest first) whose elements have `element_bytes` bytes
/// each, in the byte order of this machine, without padding.
Bytes multi_array(const std::vector<int>& shape, std::size_t element_bytes,
                  std::span<const std::byte> data);

}  // namespace navvy::formats::ros
