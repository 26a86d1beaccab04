// SPDX-License-Identifier: Apache-2.0
// The trench in one run, and resumed at three times: on the drive, in a scoop, in a swing.
#include "determinism/hashed_run.h"

namespace navvy::determinism {
namespace {

TEST(Resumed, TheTrenchContinuesBitIdenticallyThreeTimes) {
  const std::vector<std::string> times = {"4", "17.3", "31"};
  const std::string folder = run_folder("snapshots").string();
  std::filesystem::create_directories(folder);
  const auto file = [&](std::size_t i) { return folder + "/" + std::to_string(i); };
  const HashedRun whole =
      hashed_run("whole", "trench.sdf",
                 {"--duration", "40", "--snapshot", file(0), "--snapshot-at", times[0]}, {});
  EXPECT_GT(whole.summary.at("cycles").get<int>(), 0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    // Each leg writes the snapshot of the next and then continues to the end.
    std::vector<std::string> options = {"--duration", "40", "--resume", file(i)};
    if (i + 1 < times.size()) {
      const std::vector<std::string> next = {"--snapshot", file(i + 1), "--snapshot-at",
                                             times[i + 1]};
      options.insert(options.end(), next.begin(), next.end());
    }
    const HashedRun leg = hashed_run("from " + times[i], "trench.sdf", options, {});
    ASSERT_FALSE(leg.at.empty());
    const std::uint64_t from = leg.at.begin()->first;
    EXPECT_LT(from, whole.at.rbegin()->first);
    EXPECT_EQ(first_difference(whole, leg, from), "") << "resumed at " << times[i] << " s";
    EXPECT_EQ(leg.summary.at("state_hash"), whole.summary.at("state_hash"))
        << "resumed at " << times[i] << " s";
  }
}

}  // namespace
}  // namespace navvy::determinism
