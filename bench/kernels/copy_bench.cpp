// SPDX-License-Identifier: Apache-2.0
// Reference rates: a plain copy, and the cost of one launch.
#include <cstdio>
#include <exception>

#include "bench.h"
#include "device/buffer.h"
#include "device/kernel_program.h"

int main() {
  using namespace navvy;
  try {
    device::Device device;
    for (const std::size_t bytes :
         {std::size_t{1} << 20, std::size_t{1} << 24, std::size_t{1} << 28}) {
      const double bandwidth = bench::copy_bandwidth(device, bytes);
      bench::Row row;
      row.bench = "copy";
      row.particles = bytes / 16;
      row.steps = 1;
      row.timing.best = 2.0 * static_cast<double>(bytes) / bandwidth;
      row.bytes_per_particle = 32;
      bench::print(device.info(), row);
    }
    const device::KernelProgram program = device::KernelProgram::from_text(
        device, "nothing", "kernel void nothing(global int* x) { if (x[0] == 1) x[1] = 2; }");
    device::Buffer<int> x(device, 2);
    x.fill(0);
    device::Kernel nothing(program, "nothing");
    nothing.args(x);
    constexpr int kLaunches = 1000;
    bench::Row row;
    row.bench = "launch";
    row.particles = 1;
    row.steps = kLaunches;
    row.timing = bench::measure(
        device, [] {},
        [&] {
          for (int i = 0; i < kLaunches; ++i) nothing.enqueue(1);
        });
    bench::print(device.info(), row);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
