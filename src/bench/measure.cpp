// SPDX-License-Identifier: Apache-2.0
#include "bench/measure.h"

#include <algorithm>
#include <ctime>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/stopwatch.h"
#include "device/buffer.h"
#include "device/device.h"
#include "device/kernel_program.h"

namespace navvy::bench {
namespace {

// Eight sums of sixteen lanes each: enough independent work to fill the pipelines of current
// devices.
constexpr const char* kFmaSource = R"(
kernel void fma_peak(global float* out, const int rounds) {
  const float16 x = 0.999f, y = (float)get_global_id(0) * 1e-6f;
  float16 a = y, b = y + 1, c = y + 2, d = y + 3, e = y + 4, f = y + 5, g = y + 6, h = y + 7;
  for (int i = 0; i < rounds; ++i) {
    a = fma(a, x, y); b = fma(b, x, y); c = fma(c, x, y); d = fma(d, x, y);
    e = fma(e, x, y); f = fma(f, x, y); g = fma(g, x, y); h = fma(h, x, y);
  }
  const float16 sum = a + b + c + d + e + f + g + h;
  const float8 s8 = sum.lo + sum.hi;
  const float4 s4 = s8.lo + s8.hi;
  out[get_global_id(0)] = s4.x + s4.y + s4.z + s4.w;
}
)";

/// Profiles during its lifetime, also when the work throws. A profile left on would slow down the
/// following rows.
class Profiling {
 public:
  explicit Profiling(device::Device& device) : device_(device) {
    device_.set_profile(true);
    device_.clear_profile();
  }
  ~Profiling() {
    try {
      device_.set_profile(false);
    } catch (const device::DeviceError&) {
      // A destructor must not throw; the device reports the fault at its next call.
    }
  }
  Profiling(const Profiling&) = delete;
  Profiling& operator=(const Profiling&) = delete;

 private:
  device::Device& device_;
};

}  // namespace

// Processor time hardly grows when other programs use the machine.
double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The best run is the least disturbed one; noise only adds time.
Timing timing_of(std::vector<double> wall, const std::vector<double>& processor) {
  if (wall.empty()) throw Error("bench: a timing of no runs");
  std::sort(wall.begin(), wall.end());
  Timing out;
  out.best = wall.front();
  out.median = wall[wall.size() / 2];
  out.spread = (wall.back() - out.best) / out.best;
  out.runs = static_cast<int>(wall.size());
  if (!processor.empty()) out.processor = *std::min_element(processor.begin(), processor.end());
  return out;
}

Timing measure(int runs, const std::function<void()>& restore, const std::function<void()>& work) {
  std::vector<double> wall, processor;
  for (int run = 0; run < runs; ++run) {
    restore();
    const double began = processor_seconds();
    const Stopwatch watch;
    work();
    wall.push_back(watch.seconds());
    processor.push_back(processor_seconds() - began);
  }
  return timing_of(std::move(wall), processor);
}

Timing measure(device::Device& device, const std::function<void()>& restore,
               const std::function<void()>& work, int runs) {
  // Run -1 warms up: drivers compile machine code and touch memory at the first use.
  std::vector<double> times, processor;
  for (int run = -1; run < runs; ++run) {
    // Restoring queues copies, which must not run within the measured time.
    restore();
    device.finish();
    const double began = processor_seconds();
    const Stopwatch watch;
    work();
    device.finish();
    if (run < 0) continue;
    times.push_back(watch.seconds());
    processor.push_back(processor_seconds() - began);
  }
  return timing_of(std::move(times), processor);
}

double kernel_seconds(device::Device& device, const std::function<void()>& restore,
                      const std::function<void()>& work, int runs) {
  double least = 0;
  for (int run = 0; run < runs; ++run) {
    restore();
    // After the restore, so that its copies and fills do not count.
    const Profiling profiling(device);
    work();
    double sum = 0;
    for (const device::KernelTime& time : device.profile()) sum += time.seconds;
    least = run == 0 ? sum : std::min(least, sum);
  }
  return least;
}

double copy_bandwidth(device::Device& device, std::size_t bytes) {
  const device::KernelProgram program = device::KernelProgram::from_text(
      device, "copy",
      "kernel void copy(global const float4* from, global float4* to) { "
      "to[get_global_id(0)] = from[get_global_id(0)]; }");
  const std::size_t count = bytes / 16;
  device::Buffer<float> from(device, 4 * count), to(device, 4 * count);
  // Written once before the clock starts; otherwise the first touch of fresh pages would be
  // measured.
  from.fill(1);
  to.fill(0);
  device::Kernel copy(program, "copy");
  copy.args(from, to);
  // A group of 64 is a wavefront or two warps, and a CPU's driver makes vectors of it.
  const Timing timing = measure(
      device, [] {}, [&] { copy.enqueue(count, 64); });
  // Read once and written once.
  return 2.0 * static_cast<double>(bytes) / timing.best;
}

double fma_peak(device::Device& device) {
  const device::KernelProgram program =
      device::KernelProgram::from_text(device, "fma_peak", kFmaSource);
  device::Kernel kernel(program, "fma_peak");
  // A launch must take long enough to hide its own cost, and short enough for a bench of seconds: a
  // GPU takes many items, a CPU with few lanes more rounds of fewer items.
  const bool gpu = device.info().kind == device::Kind::kGpu;
  const std::size_t items = gpu ? std::size_t{1} << 20 : std::size_t{1} << 12;
  const int rounds = gpu ? 1 << 11 : 1 << 14;
  device::Buffer<float> out(device, items);
  kernel.args(out, rounds);
  const Timing timing = measure(
      device, [] {}, [&] { kernel.enqueue(items, 64); });
  // A fused multiply-add is two operations, on 16 lanes of 8 sums, for each round and item.
  return 2.0 * 16 * 8 * static_cast<double>(rounds) * static_cast<double>(items) / timing.best;
}

Peak measure_peak(device::Device& device) { return {copy_bandwidth(device), fma_peak(device)}; }

}  // namespace navvy::bench
