// SPDX-License-Identifier: Apache-2.0
// Signals reach a run wherever it is: between steps, in a driver that compiles, in one that does not answer.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "fault/attack.h"
#include "folder.h"
#include "paths.h"
#include "process.h"
#include "text_of.h"

namespace navvy::fault {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

using test::text_of;

class Stop : public testing::Test {
 protected:
  pid_t start(const char* hang) { return start({{"LD_PRELOAD", NAVVY_FAULT_SHIM}, {"NAVVY_HANG", hang}}); }
  pid_t start(const std::vector<std::pair<std::string, std::string>>& environment) {
    return test::start({NAVVY_PROGRAM,
                        {"run", navvy::source_dir() + "/scenarios/bucket_path.sdf", "--no-render", "--out", out()},
                        environment,
                        "/dev/null",
                        "/dev/null",
                        folder_ / "stderr"});
  }
  std::string out() const { return folder_ / "out"; }
  std::string complained() const { return text_of(folder_ / "stderr"); }
  nlohmann::json summary() const { return nlohmann::json::parse(text_of(out() + "/summary.json"), nullptr, false); }
  /// Until the file is there, a minute at most.
  static void wait_for_file(const std::string& path) {
    for (int i = 0; i < 1200 && !fs::exists(path); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  /// Status, and how long the process took to end [s].
  static std::pair<int, double> send(pid_t child, int signal) {
    const auto sent = Clock::now();
    kill(child, signal);
    const int status = test::wait_for(child);
    return {status, std::chrono::duration<double>(Clock::now() - sent).count()};
  }

  const test::Folder folder_;
};

// No verdict is a time here either, but for the order: the driver would hang for ten minutes.
constexpr double kLongBefore = 60;  // [s]

TEST_F(Stop, WhileTheDriverCompiles) {
  const pid_t child = start("build:1:600");
  // The folder is taken just before the device.
  wait_for_file(out() + "/navvy.run");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const auto [status, seconds] = send(child, SIGTERM);
  EXPECT_EQ(status, 130) << complained();
  EXPECT_LT(seconds, kLongBefore);
  EXPECT_NE(complained().find("driver is busy"), std::string::npos) << complained();
  std::printf("SIGTERM while the driver compiles: %.2f s\n", seconds);
}

// The compiler inside the driver has handlers of its own, which delete the file it is writing: a build that failed for
// that would be told as kernels that are wrong.
TEST_F(Stop, WhileTheDriversOwnCompilerWorks) {
  for (const int pause : {0, 700, 1400}) {  // [ms] after the folder was taken, just before the device
    fs::remove_all(out());
    const std::string cache = folder_ / ("cache" + std::to_string(pause));
    const pid_t child = start({{"POCL_CACHE_DIR", cache}});
    wait_for_file(out() + "/navvy.run");
    std::this_thread::sleep_for(std::chrono::milliseconds(pause));
    const auto [status, seconds] = send(child, SIGTERM);
    EXPECT_EQ(status, 130) << pause << " ms: " << complained();
  }
}

TEST_F(Stop, WhileTheDeviceDoesNotAnswer) {
  const pid_t child = start("wait:50:600");
  wait_for_file(out() + "/terrain_start.tif");
  std::this_thread::sleep_for(std::chrono::seconds(2));
  const auto [status, seconds] = send(child, SIGTERM);
  EXPECT_EQ(status, 130) << complained();
  EXPECT_LT(seconds, kLongBefore);
  EXPECT_EQ(summary().at("status"), "interrupted");
  EXPECT_EQ(broken_files(out()), "");
  std::printf("SIGTERM while the device does not answer: %.2f s\n", seconds);
}

TEST_F(Stop, AClosedTerminalAsCtrlCDoes) {
  for (const int signal : {SIGHUP, SIGTERM, SIGINT}) {
    fs::remove_all(out());
    const pid_t child = start("");
    wait_for_file(out() + "/terrain_start.tif");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const auto [status, seconds] = send(child, signal);
    EXPECT_EQ(status, 130) << signal << ": " << complained();
    EXPECT_EQ(summary().at("status"), "interrupted") << signal;
    EXPECT_TRUE(fs::exists(out() + "/terrain_end.tif")) << signal;
    EXPECT_FALSE(fs::exists(out() + "/summary.reserve")) << signal;
  }
}

}  // namespace
}  // namespace navvy::fault
