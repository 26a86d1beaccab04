// SPDX-License-Identifier: Apache-2.0
// Readings in processes with one and with two worker threads, and with another seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/hash.h"
#include "folder.h"
#include "process.h"
#include "sensor/all_kinds.h"
#include "session/session.h"
#include "text_of.h"

namespace navvy::sensor {
namespace {

// Names the file that a child writes the hashes of its readings to, and its seed.
constexpr const char* kFile = "NAVVY_TEST_READINGS";
constexpr const char* kSeed = "NAVVY_TEST_SEED";

/// Returns more sensors that look at the digging bucket: a scanner with rings, outliers and dropped
/// beams, and a preset.
std::string more_sensors() {
  return R"(<navvy:sensor name="rings" link="base" type="lidar"><pose>-3 0 2.2 0 0.5 0</pose>
<update_rate>20</update_rate><navvy:latency_s>0.03</navvy:latency_s>
<navvy:sweep_s>0.04</navvy:sweep_s><lidar><scan><horizontal><samples>91</samples>
<min_angle>-0.6</min_angle><max_angle>0.6</max_angle></horizontal><vertical><samples>31</samples>
<min_angle>-0.7</min_angle><max_angle>0.2</max_angle></vertical></scan><noise><type>gaussian</type>
<stddev>0.01</stddev><bias_stddev>0.02</bias_stddev></noise></lidar>
<navvy:outlier_share>0.01</navvy:outlier_share><navvy:drop_share>0.02</navvy:drop_share>
</navvy:sensor><navvy:sensor name="preset" link="base"><navvy:preset>pmd_camera</navvy:preset>
<pose>-3 0 2.2 0 0.7 0</pose></navvy:sensor>)";
}

/// Digs for 2.4 s before sensors of every kind, and writes the device and a line for each array:
/// its name, the number of its readings and a hash of all their bytes.
void write_readings(const std::string& file, std::uint64_t seed) {
  device::Device device("cpu");
  scene::Scene scene = testing::all_kinds(more_sensors());
  ASSERT_EQ(testing::kinds_in(scene), std::variant_size_v<scene::SensorKind>)
      << "a kind has no sensor here";
  scene.seed = seed;
  session::Session session(std::move(scene), device);
  for (auto& one : make_sensors(session.world())) session.add(std::move(one));
  const sim::ArrayOutputs& arrays = session.world().arrays();
  const std::size_t count = arrays.channels().size();
  std::vector<StateHash> hashes(count);
  std::vector<std::uint64_t> sequences(count);
  while (session.world().time() < 2.4) {
    session.step();
    for (std::size_t i = 0; i < count; ++i) {
      const sim::ArrayView view = arrays.view(static_cast<int>(i));
      if (view.sequence() == sequences[i]) continue;
      sequences[i] = view.sequence();
      hashes[i].bytes(view.bytes().data(), view.bytes().size());
    }
  }
  std::ofstream out(file);
  out << device.info().text() << "\n";
  for (std::size_t i = 0; i < count; ++i)
    out << arrays.channels()[i].name << ' ' << sequences[i] << ' ' << hashes[i].hex() << "\n";
}

/// Readings of a process: the line of its device, and the lines of its arrays.
struct Readings {
  std::string device, arrays;
};

/// Runs this program with that many worker threads of PoCL, as tests/determinism does.
Readings readings_of(int threads, int seed, const std::string& file) {
  const std::string n = std::to_string(threads);
  const int status =
      test::wait_for(test::start({std::filesystem::read_symlink("/proc/self/exe").string(),
                                  {"--gtest_filter=SensorThreads.*"},
                                  {{"POCL_MAX_PTHREAD_COUNT", n},
                                   {"POCL_CPU_MAX_CU_COUNT", n},
                                   {"POCL_DEVICES", "pthread"},
                                   {kFile, file},
                                   {kSeed, std::to_string(seed)}}}));
  EXPECT_EQ(status, 0);
  const std::string text = test::text_of(file);
  const std::size_t line = text.find('\n');
  return {text.substr(0, line), text.substr(line + 1)};
}

TEST(SensorThreads, OneAndTwoThreadsGiveTheSameReadings) {
  if (const char* file = std::getenv(kFile)) {
    // A child of this test.
    write_readings(file, std::strtoull(std::getenv(kSeed), nullptr, 10));
    return;
  }
  const test::Folder folder;
  const Readings one = readings_of(1, 5, folder / "one"), two = readings_of(2, 5, folder / "two"),
                 other = readings_of(2, 6, folder / "other");
  // The setting is effective: the device reports its number of workers.
  EXPECT_NE(one.device.find(" 1 compute unit"), std::string::npos) << one.device;
  EXPECT_NE(two.device.find(" 2 compute unit"), std::string::npos) << two.device;
  EXPECT_EQ(std::count(one.arrays.begin(), one.arrays.end(), '\n'), 28) << one.arrays;
  EXPECT_EQ(one.arrays, two.arrays);
  EXPECT_NE(one.arrays, other.arrays);
  // What has no errors is the same with any seed.
  const auto line_of = [](const std::string& text, const std::string& name) {
    const std::size_t at = text.find(name);
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(line_of(one.arrays, "bucket/labels/labels"),
            line_of(other.arrays, "bucket/labels/labels"));
}

}  // namespace
}  // namespace navvy::sensor
