// SPDX-License-Identifier: Apache-2.0
// Readings of sensors in both formats of bags, decoded by `rosbags` with ROS 2 Humble's own
// definitions of the messages.
#include "formats/ros/sensor_messages.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "folder.h"
#include "formats/ros/bag.h"
#include "heightfield/maps.h"
#include "paths.h"

namespace navvy::formats::ros {
namespace {

using nlohmann::json;

constexpr std::int64_t kNow = 3'250'000'007LL;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Path of the readers' Python; empty if it is not installed.
std::string readers() {
  const std::string python = navvy::source_dir() + "/build/readers/bin/python3";
  return std::filesystem::exists(python) ? python : "";
}

/// Runs a script of the readers on one argument and returns what it prints.
json printed_by(const std::string& script, const std::string& about) {
  return json::parse(
      heightfield::testing::output_of("'" + readers() + "' '" + script + "' '" + about + "'"),
      nullptr, false);
}

/// Values that float32 and double both hold exactly, so that they can be compared as equal.
void write_readings(Bag& bag) {
  const auto write = [&](const char* topic, MessageKind kind, const Bytes& bytes) {
    bag.write(topic, kind, kNow, bytes);
  };
  const MessageHeader header{kNow, "ew/front"};
  write("/scan", MessageKind::kLaserScan,
        laser_scan({header, -0.5, 0.25, 0.125, 0.0625, 0.5, 20, {1.5f, kInf, -kInf, kNan}, {7}}));
  write("/points", MessageKind::kPointCloud,
        point_cloud({header, {"x", "y", "z", "intensity"}, 2, {1, 2, 3, 4, 5, 6, 7, kNan}, false}));
  write("/sonar", MessageKind::kRange,
        range({header, RangeMessage::Radiation::kUltrasound, 0.5, 0.25, 5, 2.5}));
  write("/infrared", MessageKind::kRange,
        range({header, RangeMessage::Radiation::kInfrared, 0, 0.125, 1.5, kInf}));
  ImuMessage level{header, {}, Mat3::Zero(), {1, 2, 3}, Mat3::Identity(), {0, 0, 9.75}, {}};
  level.linear_acceleration_covariance = 4 * Mat3::Identity();
  write("/imu", MessageKind::kImu, imu(level));
  level.orientation = Mat3(Eigen::AngleAxisd(kPi, Vec3::UnitX()));
  write("/imu_with_orientation", MessageKind::kImu, imu(level));
  Mat3 covariance = Mat3::Identity();
  covariance(2, 2) = 4;
  write("/gnss", MessageKind::kNavSatFix, nav_sat_fix({header, true, 49.5, 8.5, 110, covariance}));
  write("/gnss_lost", MessageKind::kNavSatFix, nav_sat_fix({header, false, 49.5, 8.5, 110, {}}));
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  write("/picture", MessageKind::kImage,
        image({header, 2, 2, "rgb8", std::as_bytes(std::span(pixels))}));
  write("/camera_info", MessageKind::kCameraInfo,
        camera_info({header, 640, 480, 500, 510, 319.5, 239.5, 0.125}));
  bag.close();
}

void expect_readings(const json& bag) {
  ASSERT_FALSE(bag.is_discarded()) << "the reader failed";
  for (const auto& [topic, message] : bag.items()) {
    EXPECT_EQ(message.at("header").at("stamp"), json({{"sec", 3}, {"nanosec", 250000007}}));
    EXPECT_EQ(message.at("header").at("frame_id"), "ew/front") << topic;
  }
  const json& scan = bag.at("/scan");
  EXPECT_EQ(scan.at("angle_min"), -0.5);
  EXPECT_EQ(scan.at("angle_max"), 0.25) << "three steps of 0.25 rad from the first beam";
  EXPECT_EQ(scan.at("angle_increment"), 0.25);
  EXPECT_EQ(scan.at("time_increment"), 0.125);
  EXPECT_EQ(scan.at("scan_time"), 0.0625);
  EXPECT_EQ(json({scan.at("range_min"), scan.at("range_max")}), json({0.5, 20.0}));
  EXPECT_EQ(scan.at("ranges"), json({1.5, "inf", "-inf", "nan"}));
  EXPECT_EQ(scan.at("intensities"), json({7.0}));
  const json& cloud = bag.at("/points");
  EXPECT_EQ(
      json({cloud.at("height"), cloud.at("width"), cloud.at("point_step"), cloud.at("row_step")}),
      json({2, 1, 16, 16}));
  EXPECT_EQ(cloud.at("fields")[3],
            json({{"name", "intensity"}, {"offset", 12}, {"datatype", 7}, {"count", 1}}));
  EXPECT_EQ(cloud.at("is_dense"), false);
  std::vector<std::uint8_t> bytes = cloud.at("data");
  std::vector<float> values(8);
  ASSERT_EQ(bytes.size(), 32u);
  std::memcpy(values.data(), bytes.data(), 32);
  EXPECT_EQ(values[0], 1);
  EXPECT_EQ(values[6], 7);
  EXPECT_EQ(bag.at("/sonar").at("radiation_type"), 0);
  EXPECT_EQ(bag.at("/sonar").at("field_of_view"), 0.5);
  EXPECT_EQ(bag.at("/sonar").at("min_range"), 0.25);
  EXPECT_EQ(bag.at("/sonar").at("max_range"), 5);
  EXPECT_EQ(bag.at("/sonar").at("range"), 2.5);
  EXPECT_EQ(bag.at("/infrared").at("radiation_type"), 1);
  EXPECT_EQ(bag.at("/infrared").at("range"), "inf");
}

void expect_other_readings(const json& bag) {
  const json& imu = bag.at("/imu");
  EXPECT_EQ(imu.at("orientation_covariance")[0], -1.0) << "not estimated";
  EXPECT_EQ(imu.at("angular_velocity"), json({{"x", 1.0}, {"y", 2.0}, {"z", 3.0}}));
  EXPECT_EQ(imu.at("linear_acceleration"), json({{"x", 0.0}, {"y", 0.0}, {"z", 9.75}}));
  EXPECT_EQ(imu.at("angular_velocity_covariance")[4], 1.0);
  EXPECT_EQ(imu.at("linear_acceleration_covariance")[8], 4.0);
  const json& turned = bag.at("/imu_with_orientation");
  EXPECT_EQ(turned.at("orientation_covariance")[0], 0.0);
  EXPECT_NEAR(turned.at("orientation").at("x").get<double>(), 1, 1e-12);
  const json& fix = bag.at("/gnss");
  EXPECT_EQ(fix.at("status"), json({{"status", 0}, {"service", 1}}));
  EXPECT_EQ(json({fix.at("latitude"), fix.at("longitude"), fix.at("altitude")}),
            json({49.5, 8.5, 110.0}));
  EXPECT_EQ(fix.at("position_covariance")[8], 4.0);
  EXPECT_EQ(fix.at("position_covariance_type"), 3);
  EXPECT_EQ(bag.at("/gnss_lost").at("status").at("status"), -1);
  EXPECT_EQ(bag.at("/gnss_lost").at("position_covariance_type"), 0);
  const json& picture = bag.at("/picture");
  EXPECT_EQ(json({picture.at("width"), picture.at("height"), picture.at("step")}), json({2, 2, 6}));
  EXPECT_EQ(picture.at("encoding"), "rgb8");
  EXPECT_EQ(picture.at("data")[11], 12);
  const json& camera = bag.at("/camera_info");
  EXPECT_EQ(json({camera.at("width"), camera.at("height")}), json({640, 480}));
  EXPECT_EQ(camera.at("k"), json({500.0, 0.0, 319.5, 0.0, 510.0, 239.5, 0.0, 0.0, 1.0}));
  EXPECT_EQ(camera.at("p"),
            json({500.0, 0.0, 319.5, -62.5, 0.0, 510.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0}));
  EXPECT_EQ(camera.at("d"), json(std::vector<double>(5, 0.0)));
  EXPECT_EQ(camera.at("distortion_model"), "plumb_bob");
  EXPECT_EQ(camera.at("roi").at("do_rectify"), false);
}

TEST(SensorMessages, AreReadByOthersFromBothFormats) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  write_readings(*make_mcap(folder / "run.mcap"));
  write_readings(*make_bag_folder(folder / "run"));
  for (const char* name : {"run.mcap", "run"}) {
    SCOPED_TRACE(name);
    const json bag =
        printed_by(navvy::source_dir() + "/tests/formats/bag_fields.py", folder / name);
    expect_readings(bag);
    if (!bag.is_discarded()) expect_other_readings(bag);
  }
}

// Compares names and types of all fields, not defaults and constants.
const char* const kDefinitions = R"(
import json, sys
from rosbags.typesys import Stores, get_typestore, get_types_from_msg
theirs = get_typestore(Stores.ROS2_HUMBLE).fielddefs
bare = lambda fields: [(name, str(kind)) for name, kind in fields]
out = {}
for kind, text in json.load(open(sys.argv[1])).items():
    for name, (_, fields) in get_types_from_msg(text, kind).items():
        out[name] = name not in theirs or bare(fields) == bare(theirs[name][1])
print(json.dumps([out, [k for k in out if k not in theirs]]))
)";

TEST(SensorMessages, HaveTheFieldsOfRos2Humble) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  json types;
  for (int i = 0; i < kMessageKinds; ++i)
    types[type_name(static_cast<MessageKind>(i))] = definition(static_cast<MessageKind>(i));
  heightfield::testing::write_text(folder / "types.json", types.dump());
  heightfield::testing::write_text(folder / "read.py", kDefinitions);
  const json answer = printed_by(folder / "read.py", folder / "types.json");
  ASSERT_FALSE(answer.is_discarded()) << "the reader failed";
  EXPECT_GT(answer[0].size(), 25u);
  for (const auto& [name, equal] : answer[0].items()) EXPECT_EQ(equal, true) << name;
  EXPECT_EQ(answer[1], json({"grid_map_msgs/msg/GridMap", "grid_map_msgs/msg/GridMapInfo"}))
      << "all other types are part of ROS 2";
}

TEST(SensorMessages, RefusePicturesAndCloudsThatAreNotWhole) {
  const std::vector<std::uint8_t> pixels(7);
  EXPECT_THROW(image({{}, 2, 2, "rgb8", std::as_bytes(std::span(pixels))}), Error);
  EXPECT_THROW(image({{}, 0, 0, "rgb8", {}}), Error);
  EXPECT_THROW(point_cloud({{}, {"x", "y"}, 1, {1, 2, 3}, true}), Error);
  EXPECT_THROW(point_cloud({{}, {}, 1, {}, true}), Error);
}

}  // namespace
}  // namespace navvy::formats::ros
