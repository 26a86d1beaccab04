// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>
#include <thread>
#include <vector>

#include "device/kernel_program.h"

namespace navvy::device {
namespace {

const char* kCount = R"(#include "common/portable.h"
kernel void count(global int* sum, int n, int rounds) {
  const int i = get_global_id(0);
  int value = 0;
  for (int k = 0; k < rounds; ++k) value += (k ^ i) & 1;
  if (i < n) sum[i] = value;
}
)";

// PoCL before version 6 aborts the process if this goes wrong.
TEST(LaunchGuard, ThreadsMayLaunchOneKernelOverMoreAndMoreWork) {
  constexpr int kRounds = 2000, kMost = 64 * 400;
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  threads.reserve(wrong.size());
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      Device device;
      // Half of the threads use the driver without worker threads, where there is one.
      device.run_in_caller(t % 2 == 1);
      const KernelProgram program = KernelProgram::from_text(device, "count.cl", kCount);
      Kernel count(program, "count");
      Buffer<int> sum(device, kMost);
      for (int groups = 1 + static_cast<int>(t); groups <= 400; groups += 4) {
        sum.fill(0);
        count.args(sum, 64 * groups, kRounds);
        // Small launches of this thread run beside the wider ones of the others.
        for (int again = 0; again < 4; ++again) count.enqueue(static_cast<std::size_t>(64), 64);
        count.enqueue(static_cast<std::size_t>(64 * groups), 64);
        const std::vector<int> found = sum.read();
        if (std::accumulate(found.begin(), found.end(), 0) != 64 * groups * kRounds / 2) ++wrong[t];
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace navvy::device
