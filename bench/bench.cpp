// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "device/buffer.h"
#include "device/program.h"

namespace navvy::bench {
namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string field(double value, const char* format) {
  if (value == 0) return "";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Names carry commas on some devices.
std::string quoted(const std::string& text) { return "\"" + text + "\""; }

}  // namespace

Timing measure(device::Device& device, const std::function<void()>& restore, const std::function<void()>& work,
               int runs) {
  std::vector<double> times;
  for (int run = -1; run < runs; ++run) {
    restore();
    device.finish();
    const double start = seconds();
    work();
    device.finish();
    if (run >= 0) times.push_back(seconds() - start);
  }
  const auto [best, worst] = std::minmax_element(times.begin(), times.end());
  return {*best, (*worst - *best) / *best, runs};
}

double copy_bandwidth(device::Device& device, std::size_t bytes) {
  const device::Program program =
      device::Program::from_text(device, "copy",
                                 "kernel void copy(global const float4* from, global float4* to) { "
                                 "to[get_global_id(0)] = from[get_global_id(0)]; }");
  const std::size_t count = bytes / 16;
  device::Buffer<float> from(device, 4 * count), to(device, 4 * count);
  from.fill(1);
  to.fill(0);
  device::Kernel copy(program, "copy");
  copy.args(from, to);
  const Timing timing = measure(
      device, [] {}, [&] { copy.enqueue(count, 64); });
  return 2.0 * static_cast<double>(bytes) / timing.best;
}

void print(const device::DeviceInfo& device, const Row& row, double bandwidth) {
  static bool header = false;
  if (!header) {
    std::printf(
        "bench,device,driver,particles,steps,ms,spread,particle_steps_per_s,bytes_per_particle,share_of_copy_bandwidth,"
        "real_time_factor,hash\n");
    header = true;
  }
  const double particle_steps = static_cast<double>(row.particles) * static_cast<double>(row.steps);
  const double traffic = particle_steps * row.bytes_per_particle / row.timing.best;
  std::printf("%s,%s,%s,%llu,%llu,%.3f,%.3f,%s,%s,%s,%s,%s\n", row.bench.c_str(), quoted(device.name).c_str(),
              quoted(device.driver).c_str(), static_cast<unsigned long long>(row.particles),
              static_cast<unsigned long long>(row.steps), row.timing.best * 1e3, row.timing.spread,
              field(particle_steps / row.timing.best, "%.4g").c_str(), field(row.bytes_per_particle, "%.1f").c_str(),
              field(bandwidth > 0 ? traffic / bandwidth : 0, "%.3f").c_str(),
              field(row.simulated / row.timing.best, "%.3f").c_str(), row.hash.c_str());
  std::fflush(stdout);
}

}  // namespace navvy::bench
