// SPDX-License-Identifier: Apache-2.0
// A sample of the campaign (`./dev fault`): calls that fail, disks that fill up, kills.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/random.h"
#include "fault/attack.h"
#include "folder.h"

namespace navvy::fault {
namespace {

/// Uses a kernel cache of the test: files that a fault leaves in it must not affect other tests.
Attack with(const test::Folder& folder, const std::string& fault) {
  Attack out;
  out.fault = fault;
  out.environment = {{"POCL_CACHE_DIR", folder / "cache"}};
  return out;
}

TEST(Fault, ARunReportsOrSurvivesAFailedCall) {
  const test::Folder folder;
  const auto arguments = small_run(false);
  const Outcome sound = attack(folder.path().string(), arguments, with(folder, ""));
  ASSERT_EQ(sound.status, 0) << sound.said;
  ASSERT_EQ(sound.broken, "") << sound.said;
  const auto calls = count_calls(folder.path().string(), arguments, with(folder, ""));
  ASSERT_EQ(calls.size(), kKinds);
  // Spread over the whole run; the campaign covers every call.
  constexpr long kSamples = 5;
  for (const auto& [call, count] : calls) {
    ASSERT_GT(count, 0) << call;
    const char* const code = call == "open"                      ? "EMFILE"
                             : call == "new" || call == "buffer" ? "ENOMEM"
                             : call == "write"                   ? "ENOSPC"
                                                                 : "EIO";
    int reported = 0;
    for (long i = 0; i < kSamples; ++i) {
      const long n = 1 + (2 * i + 1) * count / (2 * kSamples);
      const std::string fault = call + ":" + std::to_string(n) + ":" + code;
      const Outcome got =
          attack(folder.path().string(), arguments, with(folder, fault), sound.hash);
      EXPECT_EQ(got.broken, "") << fault << " ended with " << got.status << "\n" << got.said;
      reported += got.status != 0;
    }
    std::printf("%s: %ld calls, %ld failed, %d reported\n", call.c_str(), count, kSamples,
                reported);
  }
}

TEST(Fault, AFullDiskLeavesASummaryWithStatusFailed) {
  const test::Folder folder;
  auto arguments = small_run(false);
  // The page comes after the results, and a run does not fail for want of it (below).
  arguments.push_back("--no-report");
  ASSERT_EQ(attack(folder.path().string(), arguments, with(folder, "")).status, 0)
      << "kernels are compiled once";
  const auto calls = count_calls(folder.path().string(), arguments, with(folder, ""));
  ASSERT_EQ(calls.size(), kKinds);
  ASSERT_EQ(calls[1].first, "write");
  // Full before the driver has its kernels, among the results, and at the very end.
  int with_summary = 0;
  for (const long before_the_end : {calls[1].second / 2, 30L, 20L, 12L, 6L, 2L}) {
    const long n = std::max(1L, calls[1].second - before_the_end);
    const std::string fault = "write:" + std::to_string(n) + "+:ENOSPC";
    const Outcome got = attack(folder.path().string(), arguments, with(folder, fault));
    EXPECT_EQ(got.broken, "") << fault << "\n" << got.said;
    EXPECT_NE(got.status, 0) << fault;
    with_summary += got.summary == "failed";
    if (!got.summary.empty()) {
      EXPECT_EQ(got.summary, "failed") << fault;
      EXPECT_EQ(got.status, got.said.find("OpenCL driver") == std::string::npos ? 4 : 3)
          << fault << "\n"
          << got.said;
    }
  }
  EXPECT_GT(with_summary, 1);
}

TEST(Fault, ADiskThatIsFullForThePageOnlyIsAWarning) {
  const test::Folder folder;
  const auto arguments = small_run(false);
  ASSERT_EQ(attack(folder.path().string(), arguments, with(folder, "")).status, 0)
      << "kernels are compiled once";
  const auto calls = count_calls(folder.path().string(), arguments, with(folder, ""));
  ASSERT_EQ(calls.at(1).first, "write");
  // Among the last calls are those of the page, and of the lines about it. An earlier fault ends
  // the run as failed, and its page is tried all the same.
  int page_only = 0;
  for (long before_the_end = 0; before_the_end < 6; ++before_the_end) {
    const std::string fault =
        "write:" + std::to_string(calls[1].second - before_the_end) + "+:ENOSPC";
    const Outcome got = attack(folder.path().string(), arguments, with(folder, fault));
    EXPECT_EQ(got.broken, "") << fault << "\n" << got.said;
    EXPECT_EQ(got.status, got.summary == "failed" ? 4 : 0) << fault << "\n" << got.said;
    page_only += got.status == 0 && got.said.find("no report of the run: ") != std::string::npos;
  }
  EXPECT_EQ(page_only, 1);
}

/// Otherwise the campaign would wait without a message.
TEST(Fault, AHungRunIsKilledAndReported) {
  const test::Folder folder;
  Attack hanging = with(folder, "");
  hanging.hang = "build:1:600";
  hanging.patience = 2;
  const Outcome got = attack(folder.path().string(), small_run(false), hanging);
  EXPECT_EQ(got.broken, "hung for 2 s");
  EXPECT_EQ(got.status, -SIGKILL);
}

/// Found by the campaign (allocation 43 355): the driver's compiler threw, and the run waited for
/// one of its locks for ever.
TEST(Fault, ADriverThatThrowsDuringABuildIsNamedAndNotWaitedFor) {
  const test::Folder folder;
  // Also after programs that were built: releasing those would wait as well.
  for (const char* hang : {"thrown:1:600", "thrown:3:600"}) {
    Attack thrown = with(folder, "");
    thrown.hang = hang;
    thrown.patience = 60;
    const Outcome got = attack(folder.path().string(), small_run(false), thrown);
    EXPECT_EQ(got.broken, "") << got.said;
    EXPECT_EQ(got.status, 3);
    EXPECT_NE(got.said.find("the OpenCL driver threw an exception (std::bad_alloc)"),
              std::string::npos)
        << got.said;
  }
}

TEST(Fault, AnAbortInsideTheDriverIsReportedAsSuch) {
  const test::Folder folder;
  // An abort, a failed assertion, and one after programs that were built.
  for (const char* what : {"abort:1", "assert:1", "abort:3"}) {
    Attack aborted = with(folder, "");
    aborted.abort = what;
    std::filesystem::remove_all(folder / "cache");
    const Outcome got = attack(folder.path().string(), small_run(false), aborted);
    EXPECT_EQ(got.status, 3) << what << "\n" << got.said;
    EXPECT_EQ(got.broken, "") << what;
    EXPECT_NE(got.said.find("error: abort inside the OpenCL driver, in "), std::string::npos)
        << what << "\n"
        << got.said;
    EXPECT_NE(got.said.find("(signal 6)"), std::string::npos) << got.said;
    // The driver's own message is kept.
    if (std::string(what) == "assert:1")
      EXPECT_NE(got.said.find("driver.c:7: build: assertion 'the cache is sound' failed"),
                std::string::npos)
          << got.said;
  }
}

/// The driver is not blamed for other aborts.
TEST(Fault, AnAbortOfTheProgramIsNotAttributedToTheDriver) {
  const test::Folder folder;
  Attack aborted = with(folder, "");
  aborted.abort = "own:100";
  const Outcome got = attack(folder.path().string(), small_run(false), aborted);
  EXPECT_EQ(got.status, -SIGABRT) << got.said;
  EXPECT_NE(got.said.find("error: abort inside "), std::string::npos) << got.said;
  EXPECT_EQ(got.said.find("driver"), std::string::npos) << got.said;
}

TEST(Fault, KillsWhileItCompilesAndDrawsLeaveIntactFiles) {
  const test::Folder folder;
  const auto arguments = small_run(true);
  const Outcome cold = attack(folder.path().string(), arguments, with(folder, ""));
  ASSERT_EQ(cold.broken, "") << cold.said;
  const Outcome warm = attack(folder.path().string(), arguments, with(folder, ""));
  ASSERT_EQ(warm.broken, "") << warm.said;
  Random random(5);
  for (int i = 0; i < 8; ++i) {
    // Every other one with an empty cache, where most of the time is compiling.
    const bool compiling = i % 2 == 0;
    if (compiling) std::filesystem::remove_all(folder / "cache");
    Attack killed = with(folder, "");
    killed.kill_after = random.uniform(0.05, 1.0) * (compiling ? cold.seconds : warm.seconds);
    const Outcome got = attack(folder.path().string(), arguments, killed, warm.hash);
    EXPECT_EQ(got.broken, "") << killed.kill_after << " s, ended with " << got.status << "\n"
                              << got.said;
  }
  // Damage by the kills in the kernel cache is detected.
  const Outcome after = attack(folder.path().string(), arguments, with(folder, ""), warm.hash);
  EXPECT_EQ(after.status, 0) << after.said;
  EXPECT_EQ(after.broken, "");
}

}  // namespace
}  // namespace navvy::fault
