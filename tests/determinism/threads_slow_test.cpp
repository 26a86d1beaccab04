// SPDX-License-Identifier: Apache-2.0
// A minute of the trench in two processes, with 1 and 2 threads and hashes every simulated second.
#include "determinism/hashed_run.h"

namespace navvy::determinism {
namespace {

TEST(Threads, AMinuteOfDiggingIsBitIdenticalWithOneAndTwoThreads) {
  const HashedRun one = hashed_run("one", "trench.sdf", {"--duration", "60"}, threads(1));
  const HashedRun two = hashed_run("two", "trench.sdf", {"--duration", "60"}, threads(2));
  EXPECT_NE(one.device.find(" 1 compute unit"), std::string::npos) << one.device;
  EXPECT_NE(two.device.find(" 2 compute unit"), std::string::npos) << two.device;
  EXPECT_EQ(first_difference(one, two), "");
  EXPECT_GE(one.at.size(), 61u);
  for (const char* key : {"cycles", "rebins", "activated_columns", "deposited_blocks"}) {
    std::printf("%s: %d\n", key, one.summary.at(key).get<int>());
    EXPECT_GT(one.summary.at(key).get<int>(), 0) << key;
  }
}

}  // namespace
}  // namespace navvy::determinism
