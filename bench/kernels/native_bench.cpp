// SPDX-License-Identifier: Apache-2.0
// Compares the OpenCL soil steps with the native loop of bench/native, from the same state in one
// run: a collapsing block, with the shipped flags and the full law. The native loop runs one copy
// on each thread of the OpenCL device.
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "bench.h"
#include "core/saved_state.h"
#include "native/native_soil.h"
#include "soil/particles/floor.h"
#include "soil/rig.h"

namespace {

using namespace navvy;

constexpr int kRuns = 5;

std::string size_name(std::size_t particles) { return std::to_string(particles / 1000) + "k"; }

/// Steps one copy of `start` on each of `threads` threads.
bench::Row native_row(const soil::rig::Rig& rig, const std::vector<soil::Particle>& start,
                      int steps, double dt, int threads) {
  // The surface is z = 0.
  const double ground = -rig.datum() / rig.cell();
  std::vector<bench::NativeSoil> copies;
  bench::Row row;
  row.bench = "native_loop:" + size_name(start.size());
  row.particles = start.size() * static_cast<std::size_t>(threads);
  row.steps = static_cast<std::uint64_t>(steps);
  row.simulated = steps * dt;
  row.timing = bench::measure(
      soil::rig::Rig::device(),
      [&] {
        copies.assign(static_cast<std::size_t>(threads),
                      bench::NativeSoil(rig.world().soils[0], rig.cell(), ground));
        for (bench::NativeSoil& copy : copies) copy.insert(start);
      },
      [&] {
        std::vector<std::thread> workers;
        workers.reserve(copies.size());
        for (bench::NativeSoil& copy : copies)
          workers.emplace_back([&copy, steps, dt] {
            for (int i = 0; i < steps; ++i) copy.step(dt);
          });
        for (std::thread& worker : workers) worker.join();
      },
      kRuns);
  return row;
}

bench::Row opencl_row(soil::rig::Rig& rig, std::size_t particles, int steps, double dt) {
  const std::vector<char> start = saved(rig.solver());
  bench::Row row;
  row.bench = "soil_collapse_no_tool:" + size_name(particles);
  row.particles = particles;
  row.steps = static_cast<std::uint64_t>(steps);
  row.simulated = steps * dt;
  row.timing = bench::measure(
      soil::rig::Rig::device(), [&] { load_saved(start, rig.solver()); },
      [&] {
        for (int i = 0; i < steps; ++i) rig.solver().step(dt, {}, {});
      },
      kRuns);
  row.hash = hash_of(rig.solver()).hex();
  return row;
}

void compare(double edge, int steps) {
  soil::rig::Rig rig({soil::rig::sand()});
  rig.solver().insert(rig.fill({Vec3(6, 6, 0), Vec3(6 + edge, 6 + edge, edge)}, true));
  // Measure soil that is in motion.
  rig.run(0.1);
  const auto start = rig.solver().particles();
  const double dt = rig.solver().step_limit(0);
  const device::DeviceInfo& device = soil::rig::Rig::device().info();
  const bench::Row native = native_row(rig, start, steps, dt, device.compute_units);
  const bench::Row opencl = opencl_row(rig, start.size(), steps, dt);
  bench::print(device, native);
  bench::print(device, opencl);
  const auto work = [](const bench::Row& row) {
    return 1e-6 * static_cast<double>(row.particles) * static_cast<double>(row.steps);
  };
  const double native_wall = work(native) / native.timing.best / device.compute_units,
               opencl_wall = work(opencl) / opencl.timing.best / device.compute_units;
  const double native_cpu = work(native) / native.timing.processor,
               opencl_cpu = work(opencl) / opencl.timing.processor;
  std::printf(
      "%s, M particle-steps/s per thread: native %.1f, OpenCL %.1f, ratio %.2f; per processor "
      "second: native "
      "%.1f, OpenCL %.1f, ratio %.2f\n",
      size_name(start.size()).c_str(), native_wall, opencl_wall, opencl_wall / native_wall,
      native_cpu, opencl_cpu, opencl_cpu / native_cpu);
}

}  // namespace

int main() {
  try {
    compare(1.0, 100);
    compare(2.0, 50);
    compare(3.7, 10);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
