// SPDX-License-Identifier: Apache-2.0
// Readings of sensors as ROS 2 messages of the package sensor_msgs, encoded as CDR bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "formats/ros/messages.h"

namespace navvy::formats::ros {

/// Time and frame of a reading.
struct MessageHeader {
  /// Simulated time of the reading [ns].
  std::int64_t time_ns = 0;
  /// Name of the frame that the reading refers to.
  std::string frame = kFrame;
};

/// Reading of a laser scanner with beams in the x-y plane of its frame, by increasing angle about z
/// from x. A range is +infinity without a return, -infinity for an object nearer than `range_min`,
/// and NaN for a beam that failed [REP 117].
struct LaserScanMessage {
  MessageHeader header;            ///< time of the first beam, and frame
  double angle_min = 0;            ///< angle of the first beam [rad]
  double angle_increment = 0;      ///< angle between two beams [rad]
  double time_increment = 0;       ///< time between two beams [s]
  double scan_time = 0;            ///< time between two scans [s]
  double range_min = 0;            ///< smallest valid range [m]
  double range_max = 0;            ///< greatest valid range [m]
  std::vector<float> ranges;       ///< range of each beam [m]
  std::vector<float> intensities;  ///< intensity of each beam; empty if not measured
};
/// Returns a sensor_msgs/LaserScan.
Bytes laser_scan(const LaserScanMessage& scan);

/// Points with float32 fields, such as x, y, z and intensity.
struct PointCloudMessage {
  MessageHeader header;             ///< time of the points, and frame
  std::vector<std::string> fields;  ///< names of the fields of a point
  /// Rows of an ordered cloud, 1 for points without an order.
  std::uint32_t height = 1;
  /// Fields of all points, point by point and row by row. A point without a return has NaN as x, y
  /// and z.
  std::vector<float> values;
  /// True if all values are finite.
  bool dense = true;
};
/// Returns a sensor_msgs/PointCloud2. @throws Error if the values do not fill whole points and
/// rows.
Bytes point_cloud(const PointCloudMessage& cloud);

/// Reading of a sensor with one distance, measured along x of its frame. +infinity: no object
/// within reach; -infinity: nearer than `range_min` [REP 117].
struct RangeMessage {
  /// Physical principle; the numbers are those of the message.
  enum class Radiation : std::uint8_t { kUltrasound = 0, kInfrared = 1 };
  MessageHeader header;                          ///< time of the reading, and frame
  Radiation radiation = Radiation::kUltrasound;  ///< physical principle
  double field_of_view = 0;                      ///< full angle of the cone [rad]
  double range_min = 0;                          ///< smallest valid distance [m]
  double range_max = 0;                          ///< greatest valid distance [m]
  double range = 0;                              ///< distance [m]
};
/// Returns a sensor_msgs/Range.
Bytes range(const RangeMessage& reading);

/// Reading of an inertial measurement unit, in the axes of its frame.
struct ImuMessage {
  MessageHeader header;  ///< time of the reading, and frame
  /// Rotation of the frame in the world frame; without a value the unit does not estimate it.
  std::optional<Mat3> orientation;
  Mat3 orientation_covariance = Mat3::Zero();       ///< zero: unknown [rad2]
  Vec3 angular_velocity = Vec3::Zero();             ///< angular velocity [rad/s]
  Mat3 angular_velocity_covariance = Mat3::Zero();  ///< zero: unknown [rad2/s2]
  /// Acceleration minus gravity: (0, 0, 9.81) in a level unit at rest [m/s2].
  Vec3 linear_acceleration = Vec3::Zero();
  Mat3 linear_acceleration_covariance = Mat3::Zero();  ///< zero: unknown [m2/s4]
};
/// Returns a sensor_msgs/Imu.
Bytes imu(const ImuMessage& reading);

/// Position fix of a satellite navigation receiver.
struct NavSatMessage {
  MessageHeader header;  ///< time of the fix, and frame of the antenna
  bool fix = false;      ///< false: no fix; position and covariance have no meaning
  double latitude = 0;   ///< latitude, positive north [deg]
  double longitude = 0;  ///< longitude, positive east [deg]
  /// Height above the WGS 84 ellipsoid [m]; NaN if unknown.
  double altitude = std::numeric_limits<double>::quiet_NaN();
  /// Covariance of the position, east, north and up [m2]; zero: unknown. Off-diagonal values are
  /// taken as known too.
  Mat3 covariance = Mat3::Zero();
};
/// Returns a sensor_msgs/NavSatFix.
Bytes nav_sat_fix(const NavSatMessage& reading);

/// Picture of a camera, row by row from the top. The axes of the camera's frame are those of
/// optical frames: z forward, x to the right, y down [REP 103].
struct ImageMessage {
  MessageHeader header;                 ///< time of the picture, and optical frame of the camera
  std::uint32_t width = 0, height = 0;  ///< number of pixels
  /// Type of a pixel by the names of ROS: "rgb8", "mono8", "mono16", "16UC1", "32FC1" (depth [m])
  /// and others.
  std::string encoding;
  /// Pixels without gaps between rows, in the byte order of this machine. Must remain valid during
  /// the call only.
  std::span<const std::byte> data;
};
/// Returns a sensor_msgs/Image. @throws Error if the bytes do not fill whole rows.
Bytes image(const ImageMessage& picture);

/// Pinhole of a camera without distortion.
struct CameraInfoMessage {
  MessageHeader header;                 ///< as that of the picture
  std::uint32_t width = 0, height = 0;  ///< number of pixels
  double fx = 0, fy = 0;                ///< focal lengths [pixel]
  /// Principal point [pixel]; the centre of the first pixel has the coordinates 0, 0.
  double cx = 0, cy = 0;
  /// Distance of this camera to the right of the left one of a stereo pair [m]; 0 for the left one
  /// and for single cameras.
  double baseline = 0;
};
/// Returns a sensor_msgs/CameraInfo.
Bytes camera_info(const CameraInfoMessage& camera);

}  // namespace navvy::formats::ros
