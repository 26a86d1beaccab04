// SPDX-License-Identifier: Apache-2.0
// Short version of the minute of digging: one scoop, 1 and 2 threads, snapshot and resume.
#include "determinism/hashed_run.h"
#include "device/device.h"
#include "paths.h"

namespace navvy::determinism {
namespace {

constexpr const char* kScene = "bucket_path.sdf";

TEST(Threads, OneAndTwoThreadsScoopBitIdentically) {
  const HashedRun one = hashed_run("one", kScene, {"--duration", "5"}, threads(1));
  const HashedRun two = hashed_run("two", kScene, {"--duration", "5"}, threads(2));
  // The setting is effective: the device reports its number of workers.
  EXPECT_NE(one.device.find(" 1 compute unit"), std::string::npos) << one.device;
  EXPECT_NE(two.device.find(" 2 compute unit"), std::string::npos) << two.device;
  EXPECT_EQ(first_difference(one, two), "");
  EXPECT_GE(one.at.size(), 6u) << "t = 0 .. 4 s and the end";
  // Processes that could reorder sums took place.
  for (const char* key : {"rebins", "activated_columns", "deposited_blocks"})
    EXPECT_GT(one.summary.at(key).get<int>(), 0) << key;
}

/// The driver changes in mid-run, in both directions, also beyond a snapshot.
TEST(Threads, TheCallersThreadGivesTheBitsOfTwoWorkers) {
  if (!device::Device("cpu").has_caller_driver())
    GTEST_SKIP() << "no driver for the caller's thread";
  const HashedRun two = hashed_run("two", kScene, {"--duration", "5"}, threads(2));
  const HashedRun caller =
      hashed_run("caller", kScene, {"--duration", "5"}, {{"NAVVY_FEW_PARTICLES", "1e9"}});
  EXPECT_EQ(first_difference(caller, two), "");
  const std::string snapshot = (run_folder("snapshot") / "few.snapshot").string();
  std::filesystem::create_directories(run_folder("snapshot"));
  const Environment few{
      {"NAVVY_FEW_PARTICLES", std::to_string(two.summary.at("particles_peak").get<int>() / 2)}};
  const HashedRun both = hashed_run(
      "both", kScene, {"--duration", "5", "--snapshot", snapshot, "--snapshot-at", "2.5"}, few);
  EXPECT_EQ(first_difference(both, two), "");
  const HashedRun resumed =
      hashed_run("resumed", kScene, {"--duration", "5", "--resume", snapshot}, few);
  ASSERT_FALSE(resumed.at.empty());
  EXPECT_EQ(first_difference(two, resumed, resumed.at.begin()->first), "");
}

TEST(Threads, AResumedRunContinuesWithTheSameHashes) {
  const std::string snapshot = navvy::build_dir() + "/test-determinism/resume.snapshot";
  const HashedRun whole = hashed_run(
      "whole", kScene, {"--duration", "4", "--snapshot", snapshot, "--snapshot-at", "2.5"}, {});
  const HashedRun resumed =
      hashed_run("resumed", kScene, {"--duration", "4", "--resume", snapshot}, {});
  ASSERT_FALSE(resumed.at.empty());
  const std::uint64_t from = resumed.at.begin()->first;
  EXPECT_LT(from, whole.at.rbegin()->first);
  EXPECT_EQ(first_difference(whole, resumed, from), "");
}

/// Wheels on active soil, which is deposited in columns under them.
TEST(Threads, OneAndTwoThreadsGiveBitIdenticalWheelsOnActiveSoil) {
  const std::string scene = navvy::source_dir() + "/tests/determinism/spoil.sdf";
  const std::string snapshot = (run_folder("snapshot") / "spoil.snapshot").string();
  std::filesystem::create_directories(run_folder("snapshot"));
  const HashedRun one =
      hashed_run("one", scene, {"--duration", "4", "--snapshot", snapshot, "--snapshot-at", "2.3"},
                 threads(1));
  const HashedRun two = hashed_run("two", scene, {"--duration", "4"}, threads(2));
  EXPECT_EQ(first_difference(one, two), "");
  const HashedRun resumed =
      hashed_run("resumed", scene, {"--duration", "4", "--resume", snapshot}, threads(2));
  ASSERT_FALSE(resumed.at.empty());
  EXPECT_EQ(first_difference(one, resumed, resumed.at.begin()->first), "");
}

}  // namespace
}  // namespace navvy::determinism
