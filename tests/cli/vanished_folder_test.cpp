// SPDX-License-Identifier: Apache-2.0
// The folder of the results is removed, moved or replaced while a run writes to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "cli/program_run.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;

class VanishedFolder : public test::ProgramRun {
 protected:
  /// Starts a run of a flat site that does not end by itself, and waits for its first results.
  pid_t begin(const std::string& folder) {
    const std::string scene = (directory_ / "scene.sdf").string();
    std::ofstream(scene) << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\">"
                            "<navvy:soil ref=\"loam\"/><navvy:ground><size_m>8 8</size_m>"
                            "</navvy:ground></world></sdf>";
    const std::vector<std::string> arguments{
        "run", scene, "--no-render", "--duration", "1e5", "--hash-every", "1000", "--out", folder};
    const pid_t child = start(arguments);
    for (int i = 0; i < 1200 && !fs::exists(folder + "/hashes.csv"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    return child;
  }
  /// Expects status 4, and a folder that the program names, with results up to the end.
  void expect_saved(int status) {
    EXPECT_EQ(status, 4) << complained();
    EXPECT_EQ(said().find("results:"), std::string::npos) << said();
    const std::string mark = "are saved in '";
    const std::size_t at = complained().find(mark);
    ASSERT_NE(at, std::string::npos) << complained();
    const std::size_t begin = at + mark.size();
    const fs::path saved = complained().substr(begin, complained().find('\'', begin) - begin);
    const auto summary =
        nlohmann::json::parse(test::text_of(saved / "summary.json"), nullptr, false);
    ASSERT_TRUE(summary.is_object()) << saved;
    EXPECT_EQ(summary.at("status"), "failed");
    EXPECT_NE(summary.at("message").get<std::string>().find("was removed or replaced"),
              std::string::npos);
    EXPECT_TRUE(summary.at("state_hash").is_string());
    for (const char* name : {"terrain_end.tif", "scene.sdf", "run.json", "navvy.run"})
      EXPECT_TRUE(fs::exists(saved / name)) << name;
    EXPECT_FALSE(fs::exists(saved / "summary.reserve"));
    // From the first row to the last, none missing and none cut.
    for (const char* name : {"telemetry.csv", "hashes.csv"}) {
      const std::string rows = test::text_of(saved / name);
      ASSERT_FALSE(rows.empty()) << name;
      EXPECT_EQ(rows.back(), '\n');
      const std::size_t first = rows.find('\n') + 1;
      EXPECT_EQ(rows.compare(first, 2, "0,"), 0) << name << rows.substr(first, 80);
    }
    const std::string telemetry = test::text_of(saved / "telemetry.csv");
    const auto lines = std::count(telemetry.begin(), telemetry.end(), '\n');
    // The default rate is 50 rows per second; the first row is the start.
    EXPECT_NEAR(static_cast<double>(lines) - 2, 50 * summary.at("simulated_time_s").get<double>(),
                1.5);
    fs::remove_all(saved);
  }
  int end(pid_t child) {
    kill(child, SIGINT);
    return test::wait_for(child);
  }
};

TEST_F(VanishedFolder, RemovedJustBeforeTheEnd) {
  const pid_t child = begin(out());
  fs::remove_all(out());
  expect_saved(end(child));
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(VanishedFolder, RemovedEndsTheRunAtItsNextCheckpoint) {
  const pid_t child = begin(out());
  fs::remove_all(out());
  expect_saved(test::wait_for(child));
}

TEST_F(VanishedFolder, RemovedAndMadeAnew) {
  const pid_t child = begin(out());
  fs::remove_all(out());
  fs::create_directory(out());
  expect_saved(end(child));
  EXPECT_TRUE(fs::is_empty(out())) << "the new folder is of another origin";
}

TEST_F(VanishedFolder, Emptied) {
  const pid_t child = begin(out());
  for (const auto& entry : fs::directory_iterator(out())) fs::remove_all(entry.path());
  expect_saved(end(child));
}

TEST_F(VanishedFolder, ReplacedByALinkLeavesTheFilesBehindItAlone) {
  const pid_t child = begin(out());
  const fs::path other = directory_ / "other";
  fs::create_directory(other);
  for (const char* name : {"summary.json", "telemetry.csv", "terrain_end.tif"})
    std::ofstream(other / name) << "not of this run";
  fs::rename(out(), directory_ / "moved");
  fs::create_directory_symlink(other, out());
  expect_saved(end(child));
  for (const char* name : {"summary.json", "telemetry.csv", "terrain_end.tif"})
    EXPECT_EQ(test::text_of(other / name), "not of this run");
  EXPECT_EQ(std::distance(fs::directory_iterator(other), fs::directory_iterator()), 3);
}

TEST_F(VanishedFolder, RemovedWithItsParent) {
  const fs::path parent = directory_ / "parent";
  const pid_t child = begin((parent / "out").string());
  fs::remove_all(parent);
  expect_saved(end(child));
}

TEST_F(VanishedFolder, ALinkToItInItsPlaceIsTheSameFolder) {
  const pid_t child = begin(out());
  fs::rename(out(), directory_ / "moved");
  fs::create_directory_symlink("moved", out());
  EXPECT_EQ(end(child), 130) << complained();
  EXPECT_EQ(summary().at("status"), "interrupted");
}

}  // namespace
}  // namespace navvy
