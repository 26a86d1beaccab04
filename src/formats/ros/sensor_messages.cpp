// SPDX-License-Identifier: Apache-2.0
#include "formats/ros/sensor_messages.h"

#include <algorithm>

#include "core/error.h"
#include "formats/ros/cdr_writer.h"

namespace navvy::formats::ros {
namespace {

/// Appends the header of a reading.
CdrWriter& begin(CdrWriter& out, const MessageHeader& header) {
  return out.header(header.time_ns, header.frame);
}

float single(double value) { return static_cast<float>(value); }

}  // namespace

Bytes laser_scan(const LaserScanMessage& scan) {
  CdrWriter out(4 * (scan.ranges.size() + scan.intensities.size()));
  const double beams = static_cast<double>(scan.ranges.size());
  const double angle_max = scan.angle_min + scan.angle_increment * std::max(0.0, beams - 1);
  begin(out, scan.header) << single(scan.angle_min) << single(angle_max)
                          << single(scan.angle_increment) << single(scan.time_increment)
                          << single(scan.scan_time) << single(scan.range_min)
                          << single(scan.range_max);
  out.sequence(scan.ranges).sequence(scan.intensities);
  return out.bytes();
}

Bytes point_cloud(const PointCloudMessage& cloud) {
  const std::size_t fields = cloud.fields.size();
  if (fields == 0 || cloud.height == 0 || cloud.values.size() % (fields * cloud.height) != 0)
    throw Error("point_cloud: " + std::to_string(cloud.values.size()) + " values do not fill " +
                std::to_string(cloud.height) + " rows of points with " + std::to_string(fields) +
                " fields");
  const auto width = static_cast<std::uint32_t>(cloud.values.size() / fields / cloud.height);
  const auto step = static_cast<std::uint32_t>(4 * fields);
  CdrWriter out(4 * cloud.values.size());
  begin(out, cloud.header) << cloud.height << width << static_cast<std::uint32_t>(fields);
  std::uint32_t offset = 0;
  for (const std::string& field : cloud.fields) {
    // 7 stands for FLOAT32; each field has one element.
    out << field << offset << std::uint8_t{7} << std::uint32_t{1};
    offset += 4;
  }
  out << false << step << step * width;
  out.sequence(std::span(reinterpret_cast<const std::uint8_t*>(cloud.values.data()),
                         4 * cloud.values.size()))
      << cloud.dense;
  return out.bytes();
}

Bytes range(const RangeMessage& reading) {
  CdrWriter out;
  begin(out, reading.header) << static_cast<std::uint8_t>(reading.radiation)
                             << single(reading.field_of_view) << single(reading.range_min)
                             << single(reading.range_max) << single(reading.range);
  return out.bytes();
}

// A first covariance of -1 states that the orientation is not estimated.
Bytes imu(const ImuMessage& reading) {
  CdrWriter out;
  Mat3 covariance = reading.orientation_covariance;
  if (!reading.orientation) covariance(0, 0) = -1;
  begin(out, reading.header).rotation(reading.orientation.value_or(Mat3::Identity()));
  out.matrix(covariance).vector(reading.angular_velocity);
  out.matrix(reading.angular_velocity_covariance).vector(reading.linear_acceleration);
  return out.matrix(reading.linear_acceleration_covariance).bytes();
}

Bytes nav_sat_fix(const NavSatMessage& reading) {
  // Status -1 is no fix and 0 a fix without augmentation; service 1 is GPS. Covariance types: 0
  // unknown, 3 known.
  const bool known = reading.fix && !reading.covariance.isZero(0);
  CdrWriter out;
  begin(out, reading.header) << static_cast<std::int8_t>(reading.fix ? 0 : -1) << std::uint16_t{1};
  out << reading.latitude << reading.longitude << reading.altitude;
  out.matrix(reading.covariance) << static_cast<std::uint8_t>(known ? 3 : 0);
  return out.bytes();
}

Bytes image(const ImageMessage& picture) {
  if (picture.width == 0 || picture.height == 0 || picture.data.empty() ||
      picture.data.size() % picture.height != 0)
    throw Error("image: " + std::to_string(picture.data.size()) + " bytes do not fill " +
                std::to_string(picture.height) + " rows of " + std::to_string(picture.width) +
                " pixels");
  const auto step = static_cast<std::uint32_t>(picture.data.size() / picture.height);
  CdrWriter out(picture.data.size());
  begin(out, picture.header) << picture.height << picture.width << picture.encoding
                             << std::uint8_t{0} << step;
  out.sequence(
      std::span(reinterpret_cast<const std::uint8_t*>(picture.data.data()), picture.data.size()));
  return out.bytes();
}

Bytes camera_info(const CameraInfoMessage& camera) {
  CdrWriter out;
  begin(out, camera.header) << camera.height << camera.width << std::string("plumb_bob");
  // Five coefficients of distortion, none of which is used.
  out.sequence(std::vector<double>(5, 0.0));
  Mat3 K = Mat3::Identity();
  K(0, 0) = camera.fx, K(1, 1) = camera.fy, K(0, 2) = camera.cx, K(1, 2) = camera.cy;
  out.matrix(K).matrix(Mat3::Identity());
  // The projection has a fourth column, which moves the pixels of a right camera.
  Eigen::Matrix<double, 3, 4> P = Eigen::Matrix<double, 3, 4>::Zero();
  P.leftCols<3>() = K;
  P(0, 3) = -camera.fx * camera.baseline;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) out << P(row, column);
  // No binning, and the whole picture as region of interest.
  for (int i = 0; i < 6; ++i) out << std::uint32_t{0};
  out << false;
  return out.bytes();
}

}  // namespace navvy::formats::ros
