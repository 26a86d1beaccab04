// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>
#include <thread>
#include <vector>

#include "device/kernel_program.h"

namespace navvy::device {
namespace {

/// Returns a program of so many kernels, count0 to count<n - 1>.
std::string program_of(int kernels) {
  std::string text = "#include \"common/portable.h\"\n";
  for (int k = 0; k < kernels; ++k)
    text += "kernel void count" + std::to_string(k) + R"((global int* sum, int n, int rounds) {
  const int i = get_global_id(0);
  int value = 0;
  for (int k = 0; k < rounds; ++k) value += (k ^ i) & 1;
  if (i < n) sum[i] = value;
}
)";
  return text;
}

/// Launches `kernels` kernels over more and more work-items in four threads, half of them in the
/// caller's thread.
void launch_in_threads(int kernels, int steps) {
  constexpr int kRounds = 1000;
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  threads.reserve(wrong.size());
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      Device device;
      device.run_in_caller(t % 2 == 1);
      const KernelProgram program =
          KernelProgram::from_text(device, "count.cl", program_of(kernels));
      std::vector<Kernel> counts;
      counts.reserve(static_cast<std::size_t>(kernels));
      for (int k = 0; k < kernels; ++k) counts.emplace_back(program, "count" + std::to_string(k));
      Buffer<int> sum(device, static_cast<std::size_t>(64 * (4 * steps + 8)));
      for (int step = 0; step < steps; ++step) {
        const int groups = 1 + static_cast<int>(t) + 4 * step;
        // Each thread has another order.
        Kernel& count =
            counts[static_cast<std::size_t>((step * (2 * static_cast<int>(t) + 1)) % kernels)];
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

// PoCL before version 6 aborts the process if these go wrong.
TEST(LaunchGuard, ThreadsMayLaunchOneKernelOverMoreAndMoreWork) { launch_in_threads(1, 100); }

// PoCL keeps 128 copies of kernels.
TEST(LaunchGuard, ThreadsMayLaunchMoreKernelsThanTheDriverKeeps) { launch_in_threads(8, 300); }

}  // namespace
}  // namespace navvy::device
