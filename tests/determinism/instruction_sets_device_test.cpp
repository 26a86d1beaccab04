// SPDX-License-Identifier: Apache-2.0
// The same scoop in kernels built for AVX2 and for this processor.
#include "determinism/hashed_run.h"

namespace navvy::determinism {
namespace {

TEST(InstructionSets, Avx2AndAvx512DigBitIdentically) {
  const HashedRun own = hashed_run("own", "bucket_path.sdf", {"--duration", "3"}, {});
  if (own.device.find("avx512") == std::string::npos)
    GTEST_SKIP() << "no AVX-512 here: " << own.device;
  const HashedRun other = hashed_run("avx2", "bucket_path.sdf", {"--duration", "3"}, avx2());
  if (other.device == own.device)
    GTEST_SKIP() << "this PoCL does not take a processor's name: " << own.device;
  std::printf("%s\n%s\n", own.device.c_str(), other.device.c_str());
  EXPECT_EQ(first_difference(own, other), "");
}

}  // namespace
}  // namespace navvy::determinism
