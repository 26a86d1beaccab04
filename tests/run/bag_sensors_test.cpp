// SPDX-License-Identifier: Apache-2.0
// Readings of sensors in a recorded bag against the arrays that they came from, read by `rosbags`
// (tests/formats/bag_fields.py).
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/file.h"
#include "device/device.h"
#include "folder.h"
#include "heightfield/maps.h"
#include "paths.h"
#include "record/map_recorder.h"
#include "scene_io/loader.h"

namespace navvy::run {
namespace {

using nlohmann::json;
using record::SensorStream;

constexpr float kInf = std::numeric_limits<float>::infinity();

const char* const kScene = R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w">
<navvy:soil ref="gravel"/><navvy:ground><size_m>8 6</size_m><depth_m>0.5</depth_m></navvy:ground>
<model name="m"><pose>1 2 0 0 0 0.5</pose><static>true</static><link name="base"><pose>0 0 1 0 0 0</pose></link></model>
<navvy:record name="bag"><format>bag</format></navvy:record>
<navvy:recording><duration_s>1</duration_s><render>false</render></navvy:recording></world></sdf>)";

/// Publishes fixed values as the arrays of one sensor of each kind, at 10 Hz.
class Readings final : public sim::Sampler {
 public:
  std::string name() const override { return "readings"; }
  double rate() const override { return 10; }
  void declare(sim::Publisher& out) override {
    const auto add = [&](const char* name, sim::ElementType type, std::vector<int> shape) {
      arrays_.push_back(out.declare(
          {"m/" + std::string(name), "1", name, "m/" + std::string(name), type, shape, 10}));
    };
    using sim::ElementType;
    add("scan", ElementType::kFloat32, {3});
    add("rings", ElementType::kFloat32, {2, 2});
    add("sonar", ElementType::kFloat32, {1});
    add("turning", ElementType::kFloat64, {3});
    add("pushing", ElementType::kFloat64, {3});
    add("heading", ElementType::kFloat64, {4});
    add("place", ElementType::kFloat64, {3});
    add("depth", ElementType::kFloat32, {2, 4});
    add("state", ElementType::kFloat64, {3});
  }
  void sample(const sim::World&, sim::Publisher& out) override {
    const auto set = [&]<class T>(int array, const std::vector<T>& values) {
      const std::span<T> to = out.fill<T>(arrays_[static_cast<std::size_t>(array)]);
      std::copy(values.begin(), values.end(), to.begin());
    };
    set(0, std::vector<float>{1.5f, kInf, 2.5f});
    set(1, std::vector<float>{1, 2, kInf, 4});
    set(2, std::vector<float>{0.75f});
    set(3, std::vector<double>{0.1, 0.2, 0.3});
    set(4, std::vector<double>{0, 0, 9.81});
    set(5, std::vector<double>{std::sqrt(0.5), 0, 0, std::sqrt(0.5)});
    set(6, std::vector<double>{100, 200, 3});
    set(7, std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8});
    set(8, std::vector<double>{0.5, -0.25, 40});
  }
  void visit(Archive&) override {}

 private:
  std::vector<int> arrays_;
};

std::vector<SensorStream> streams() {
  const double h = std::sqrt(0.5);
  SensorStream::Inertial inertial{3, 4, 5, {1e-4, 1e-4, 1e-4}, {0.01, 0.01, 0.01}};
  std::vector<SensorStream> out;
  const auto add = [&](const char* name, auto kind) {
    out.push_back({0, 0, "m", name, name, make_pose(0.5, 0, 0.25), std::move(kind)});
  };
  add("scanner", SensorStream::Scan{0, -0.5, 0.5, 0.01, 0.1, 0.05, 20});
  add("rings", SensorStream::Cloud{
                   1, -1, 2, {Vec3::UnitX(), {h, h, 0}, Vec3::UnitX(), {h, 0, h}}, {0, 1, 0, 1}});
  add("sonar",
      SensorStream::Distance{2, formats::ros::RangeMessage::Radiation::kUltrasound, 0.5, 0.15, 5});
  add("imu", inertial);
  add("gnss", SensorStream::Fix{6, {4, 4, 9}});
  add("camera", SensorStream::Picture{7, "32FC1", kPi / 2, 0});
  add("gauge", SensorStream::Joint{8, "boom"});
  return out;
}

void expect_beams(const json& bag) {
  EXPECT_EQ(bag.at("/m/scanner/scan").at("ranges"), json({1.5, "inf", 2.5}));
  EXPECT_EQ(bag.at("/m/scanner/scan").at("angle_max"), 0.5);
  EXPECT_EQ(bag.at("/m/scanner/scan").at("header").at("frame_id"), "m/scanner");
  EXPECT_EQ(bag.at("/m/scanner/scan").at("header").at("stamp"), json({{"sec", 0}, {"nanosec", 0}}));
  const json& cloud = bag.at("/m/rings/points");
  EXPECT_EQ(json({cloud.at("height"), cloud.at("width")}), json({2, 2}));
  const std::vector<std::uint8_t> bytes = cloud.at("data");
  std::vector<float> values(16);
  ASSERT_EQ(bytes.size(), 64u);
  std::memcpy(values.data(), bytes.data(), 64);
  // x, y, z and time of each point; the third beam has no return.
  EXPECT_FLOAT_EQ(values[4], static_cast<float>(2 * std::sqrt(0.5)));
  EXPECT_FLOAT_EQ(values[5], values[4]);
  EXPECT_EQ(values[7], 1);
  EXPECT_TRUE(std::isnan(values[8]));
  EXPECT_FLOAT_EQ(values[14], static_cast<float>(4 * std::sqrt(0.5)));
  EXPECT_EQ(bag.at("/m/sonar/range").at("range"), 0.75);
}

void expect_others(const json& bag) {
  const json& imu = bag.at("/m/imu/imu");
  EXPECT_EQ(imu.at("linear_acceleration").at("z"), 9.81);
  EXPECT_EQ(imu.at("angular_velocity").at("x"), 0.1);
  EXPECT_NEAR(imu.at("orientation").at("z").get<double>(), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(imu.at("linear_acceleration_covariance")[4], 0.01);
  // 1 minute of arc along the meridian at the equator is 1842.9 m, along the equator 1855.3 m.
  const json& fix = bag.at("/m/gnss/fix");
  EXPECT_NEAR(fix.at("latitude").get<double>(), 200 / 1842.9 / 60, 1e-7);
  EXPECT_NEAR(fix.at("longitude").get<double>(), 100 / 1855.3 / 60, 1e-7);
  EXPECT_EQ(fix.at("altitude"), 3.0);
  EXPECT_EQ(fix.at("position_covariance_type"), 3);
  const json& camera = bag.at("/m/camera/camera_info");
  EXPECT_EQ(json({camera.at("width"), camera.at("height")}), json({4, 2}));
  // 90 degrees over four pixels.
  EXPECT_NEAR(camera.at("k")[0].get<double>(), 2, 1e-12);
  EXPECT_EQ(json({camera.at("k")[2], camera.at("k")[5]}), json({1.5, 0.5}));
  EXPECT_EQ(bag.at("/m/camera/image").at("step"), 16);
  EXPECT_EQ(bag.at("/m/camera/image").at("header").at("frame_id"), "m/camera_optical");
  EXPECT_EQ(bag.at("/m/gauge/joint_states").at("effort"), json({40.0}));
  EXPECT_EQ(bag.at("/m/gauge/joint_states").at("name"), json({"boom"}));
}

TEST(BagSensors, HoldEachReadingOnceAsMessagesOfSensorMsgs) {
  const std::string python = navvy::source_dir() + "/build/readers/bin/python3";
  if (!std::filesystem::exists(python)) GTEST_SKIP() << "rosbags is missing: ./dev readers";
  const navvy::test::Folder folder;
  device::Device device;
  session::Session session(
      scene_io::load_scene_from_string(kScene, "scene.sdf", control::step_kinds()), device);
  session.add(std::make_unique<Readings>());
  record::RunFolder results(folder / "out");
  results.begin();
  record::MapRecorder recorder(session, results, streams());
  // Before the second sample.
  for (int i = 0; i < 20; ++i) {
    recorder.observe();
    session.step();
  }
  recorder.finish();
  const json bag = json::parse(
      heightfield::testing::output_of("'" + python + "' '" + navvy::source_dir() +
                                      "/tests/formats/bag_fields.py' '" + folder / "out/bag" + "'"),
      nullptr, false);
  ASSERT_FALSE(bag.is_discarded()) << "the reader failed";
  expect_beams(bag);
  expect_others(bag);
  // Arrays that are in a message are not written again; a position in W is.
  EXPECT_FALSE(bag.contains("/m/scan"));
  EXPECT_TRUE(bag.contains("/m/place"));
  const std::vector<char> metadata = read_file(folder / "out/bag/metadata.yaml");
  EXPECT_NE(std::string(metadata.begin(), metadata.end())
                .find("name: /m/scanner/scan\n        type: sensor_msgs/msg/LaserScan"),
            std::string::npos);
  // Sensors hang on their links; cameras look along z of their optical frames.
  for (const json& transform : bag.at("/tf_static").at("transforms")) {
    if (transform.at("child_frame_id") == "m/scanner")
      EXPECT_EQ(transform.at("header").at("frame_id"), "m/base");
    if (transform.at("child_frame_id") != "m/camera_optical") continue;
    const json& q = transform.at("transform").at("rotation");
    const Eigen::Quaterniond R(q.at("w").get<double>(), q.at("x").get<double>(),
                               q.at("y").get<double>(), q.at("z").get<double>());
    EXPECT_LT((R * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12);
    EXPECT_LT((R * Vec3::UnitY() + Vec3::UnitZ()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace navvy::run
