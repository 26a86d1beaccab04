// SPDX-License-Identifier: Apache-2.0
// Signals reach a run in any state: between steps, in a driver that compiles, in one that does not
// answer.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>

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
  pid_t start(const char* hang) {
    return start({{"LD_PRELOAD", NAVVY_FAULT_SHIM}, {"NAVVY_HANG", hang}});
  }
  pid_t start(const std::vector<std::pair<std::string, std::string>>& environment) {
    return test::start(
        {NAVVY_PROGRAM,
         {"run", navvy::source_dir() + "/scenarios/bucket_path.sdf", "--no-render", "--out", out()},
         environment,
         "/dev/null",
         "/dev/null",
         folder_ / "stderr"});
  }
  std::string out() const { return folder_ / "out"; }
  std::string complained() const { return text_of(folder_ / "stderr"); }
  nlohmann::json summary() const {
    return nlohmann::json::parse(text_of(out() + "/summary.json"), nullptr, false);
  }
  /// Waits until the file exists, a minute at most.
  static void wait_for_file(const std::string& path) {
    for (int i = 0; i < 1200 && !fs::exists(path); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  /// End of a process after a signal.
  struct Ended {
    int status = 0;  ///< exit status, or minus the signal that ended it
    /// Wall time from the signal to the end; printed only, as other processes load the machine.
    double seconds = 0;
    /// Processor time in this period, summed over its threads [s].
    double processor = 0;
  };
  static Ended send(pid_t child, int signal) {
    const auto sent = Clock::now();
    const double before = processor_time(child);
    kill(child, signal);
    int raw = 0;
    rusage used{};
    wait4(child, &raw, 0, &used);
    const auto in_seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    const Ended ended{WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw),
                      std::chrono::duration<double>(Clock::now() - sent).count(),
                      in_seconds(used.ru_utime) + in_seconds(used.ru_stime) - before};
    std::printf("signal %d: %.2f s to the end, %.2f s of a processor\n", signal, ended.seconds,
                ended.processor);
    return ended;
  }

  const test::Folder folder_;
};

// A signal takes effect within 2 s of the process's own time: a run that continues its steps, or
// waits for a compiler, uses more. A sleeping one uses none, so the driver of these tests would
// hang for ten minutes; only this order of magnitude is checked by wall time, which other processes
// affect too.
constexpr double kSoon = 2;         // [s] of a processor
constexpr double kLongBefore = 60;  // [s]

TEST_F(Stop, WorksWhileTheDriverCompiles) {
  const pid_t child = start("build:1:600");
  // The folder is locked just before the device is opened.
  wait_for_file(out() + "/navvy.run");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const Ended ended = send(child, SIGTERM);
  EXPECT_EQ(ended.status, 130) << complained();
  EXPECT_LT(ended.seconds, kLongBefore);
  EXPECT_LT(ended.processor, kSoon);
  EXPECT_NE(complained().find("the OpenCL driver was busy compiling kernels: the run does not"),
            std::string::npos)
      << complained();
}

// The driver has nothing to do with the files of a site of 10^9 columns.
TEST_F(Stop, NamesTheFileThatIsBeingWritten) {
  const std::string scene = folder_ / "large.sdf";
  std::ofstream(scene) << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"large\">"
                          "<navvy:soil ref=\"loam\"/><navvy:ground><size_m>3200 3200</size_m>"
                          "</navvy:ground></world></sdf>";
  const pid_t child =
      test::start({NAVVY_PROGRAM,
                   {"run", scene, "--no-render", "--duration", "0.1", "--out", out()},
                   {},
                   "/dev/null",
                   "/dev/null",
                   folder_ / "stderr"});
  wait_for_file(out() + "/terrain_start.tif.part");
  const Ended ended = send(child, SIGTERM);
  EXPECT_EQ(ended.status, 130) << complained();
  EXPECT_LT(ended.seconds, kLongBefore);
  EXPECT_NE(complained().find("a terrain file was being written"), std::string::npos)
      << complained();
  EXPECT_EQ(complained().find("driver was"), std::string::npos) << complained();
}

// The compiler inside the driver has its own handlers, which delete the file it is writing: the
// failed build would be reported as faulty kernels.
TEST_F(Stop, WorksWhileTheDriversCompilerRuns) {
  // Delay after the folder was locked, just before the device [ms].
  for (const int pause : {0, 700, 1400}) {
    fs::remove_all(out());
    const std::string cache = folder_ / ("cache" + std::to_string(pause));
    const pid_t child = start({{"POCL_CACHE_DIR", cache}});
    wait_for_file(out() + "/navvy.run");
    std::this_thread::sleep_for(std::chrono::milliseconds(pause));
    const Ended ended = send(child, SIGTERM);
    EXPECT_EQ(ended.status, 130) << pause << " ms: " << complained();
    EXPECT_LT(ended.processor, kSoon) << pause << " ms";
  }
}

TEST_F(Stop, WorksWhileTheDeviceDoesNotAnswer) {
  const pid_t child = start("wait:50:600");
  wait_for_file(out() + "/terrain_start.tif");
  std::this_thread::sleep_for(std::chrono::seconds(2));
  const Ended ended = send(child, SIGTERM);
  EXPECT_EQ(ended.status, 130) << complained();
  EXPECT_LT(ended.seconds, kLongBefore);
  EXPECT_LT(ended.processor, kSoon);
  EXPECT_EQ(summary().at("status"), "interrupted");
  // In a finished run no program is running.
  EXPECT_EQ(summary().at("programs").at(0).at("state"), "interrupted");
  EXPECT_EQ(broken_files(out()), "");
}

// `timeout` and others signal the process, then its group: it gets each signal twice.
TEST_F(Stop, TreatsTwoSignalsAtOnceAsOne) {
  for (const int pause : {0, 20}) {  // [ms]
    fs::remove_all(out());
    const pid_t child = start("");
    wait_for_file(out() + "/terrain_start.tif");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    kill(child, SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(pause));
    const Ended ended = send(child, SIGTERM);
    EXPECT_EQ(ended.status, 130) << complained();
    EXPECT_EQ(summary().at("status"), "interrupted");
    EXPECT_EQ(summary().at("message"), "SIGTERM");
    EXPECT_TRUE(summary().at("state_hash").is_string()) << summary();
    EXPECT_TRUE(fs::exists(out() + "/terrain_end.tif"));
    EXPECT_EQ(complained().find("interrupted"), std::string::npos) << complained();
  }
}

TEST_F(Stop, AClosedTerminalActsLikeCtrlC) {
  for (const int signal : {SIGHUP, SIGTERM, SIGINT}) {
    fs::remove_all(out());
    const pid_t child = start("");
    wait_for_file(out() + "/terrain_start.tif");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const Ended ended = send(child, signal);
    EXPECT_EQ(ended.status, 130) << signal << ": " << complained();
    EXPECT_LT(ended.processor, kSoon) << signal;
    EXPECT_EQ(summary().at("status"), "interrupted") << signal;
    EXPECT_TRUE(fs::exists(out() + "/terrain_end.tif")) << signal;
    EXPECT_FALSE(fs::exists(out() + "/summary.reserve")) << signal;
  }
}

}  // namespace
}  // namespace navvy::fault
