// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <link.h>

#include <cstdlib>
#include <numeric>
#include <string>
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

/// Returns the number of shared libraries that this process has loaded so far.
unsigned long long loads() {
  unsigned long long count = 0;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        *static_cast<unsigned long long*>(data) = info->dlpi_adds;
        return 1;
      },
      &count);
  return count;
}

/// Launches eight kernels over 1 to 40 groups in worker threads, then in the caller's thread, and
/// ends the process: with 0 if the latter loaded nothing and all sums are right.
[[noreturn]] void launch_with_both_drivers() {
  constexpr int kKernels = 8, kWidest = 40;
  Device device;
  std::string text = "#include \"common/portable.h\"\n#include \"common/group_index.h\"\n";
  for (int k = 0; k < kKernels; ++k)
    text += "kernel void add" + std::to_string(k) +
            "(global int* sum) { sum[group_index()] += " + std::to_string(k + 1) + "; }\n";
  const KernelProgram program = KernelProgram::from_text(device, "add.cl", text);
  std::vector<Kernel> kernels;
  kernels.reserve(kKernels);
  for (int k = 0; k < kKernels; ++k) kernels.emplace_back(program, "add" + std::to_string(k));
  Buffer<int> sum(device, static_cast<std::size_t>(kWidest));
  sum.fill(0);
  const auto launch_all = [&](int groups) {
    for (Kernel& kernel : kernels)
      kernel.args(sum).enqueue_groups(static_cast<std::size_t>(groups));
    device.finish();
  };
  // One copy of each kernel for each number of groups would be more than PoCL keeps.
  for (int groups = 1; groups <= kWidest; ++groups) launch_all(groups);
  device.run_in_caller(true);
  launch_all(kWidest);
  const unsigned long long before = loads();
  for (int groups = 1; groups <= kWidest; ++groups) launch_all(groups);
  int wrong = loads() == before ? 0 : 1;
  // All kernels together add 36.
  const std::vector<int> found = sum.read();
  for (int i = 0; i < kWidest; ++i)
    if (found[static_cast<std::size_t>(i)] != 36 * (2 * (kWidest - i) + 1)) wrong |= 2;
  std::exit(wrong);
}

// PoCL would otherwise unload and load a kernel at each of these launches in the caller's thread.
// In a process of its own: the launches of other tests stay in PoCL's list of copies.
TEST(LaunchGuard, GroupsOfManyNumbersLeaveKernelsLoaded) {
  if (!Device().has_caller_driver()) GTEST_SKIP() << "no driver for the caller's thread";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(launch_with_both_drivers(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace navvy::device
