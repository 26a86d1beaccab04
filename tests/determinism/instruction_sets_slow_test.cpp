// SPDX-License-Identifier: Apache-2.0
// A minute of the trench in kernels built for AVX2 and for this processor, with hashes every
// simulated second.
#include "determinism/hashed_run.h"

namespace navvy::determinism {
namespace {

TEST(InstructionSets, AMinuteOfDiggingIsBitIdenticalForAvx2AndAvx512) {
  const HashedRun own = hashed_run("own60", "trench.sdf", {"--duration", "60"}, {});
  if (own.device.find("avx512") == std::string::npos)
    GTEST_SKIP() << "no AVX-512 here: " << own.device;
  const HashedRun other = hashed_run("avx260", "trench.sdf", {"--duration", "60"}, avx2());
  if (other.device == own.device)
    GTEST_SKIP() << "this PoCL does not take a processor's name: " << own.device;
  EXPECT_EQ(first_difference(own, other), "");
  EXPECT_GE(own.at.size(), 61u);
}

}  // namespace
}  // namespace navvy::determinism
