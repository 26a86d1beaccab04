// SPDX-License-Identifier: Apache-2.0
#include "bench/native_rows.h"

#include <thread>
#include <vector>

#include "bench/measure.h"
#include "bench/native/native_soil.h"
#include "bench/soil_rows.h"
#include "bench/soil_steps.h"
#include "core/error.h"
#include "device/device.h"

namespace navvy::bench {
namespace {

constexpr int kRuns = 3;

/// One size: edge of the block [m] and number of steps in a run.
struct Size {
  const char* name;
  double edge;
  int steps;
};
constexpr Size kSizes[] = {{"8k", 1.0, 100}, {"64k", 2.0, 50}, {"405k", 3.7, 10}};

/// Times a copy of the particles `start` of a site on each thread of the device, over the steps of
/// `like`.
Row native_row(device::Device& device, const lab::Site& site,
               const std::vector<soil::Particle>& start, const Row& like) {
  const auto threads = static_cast<std::size_t>(device.info().compute_units);
  // The surface is z = 0.
  const double ground = -site.ground().datum() / site.cell();
  const double dt = like.simulated / static_cast<double>(like.steps);
  std::vector<NativeSoil> copies;
  Row row;
  row.particles = start.size() * threads;
  row.steps = like.steps;
  row.simulated = like.simulated;
  row.timing = measure(
      device,
      [&] {
        copies.assign(threads, NativeSoil(site.soil(), site.cell(), ground));
        for (NativeSoil& copy : copies) copy.insert(start);
      },
      [&] {
        std::vector<std::thread> workers;
        workers.reserve(copies.size());
        for (NativeSoil& copy : copies)
          workers.emplace_back([&copy, &row, dt] {
            for (std::uint64_t i = 0; i < row.steps; ++i) copy.step(dt);
          });
        for (std::thread& worker : workers) worker.join();
      },
      kRuns);
  return row;
}

}  // namespace

void run_native_cases(device::Device& device, const std::string& only,
                      const std::function<void(const Row&)>& take) {
  if (device.info().kind != device::Kind::kCpu)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--native", device.info().name,
                           "the native loop runs on the processor", "--device cpu"});
  bool found = false;
  for (const Size& size : kSizes) {
    if (std::string(size.name).find(only) == std::string::npos) continue;
    found = true;
    const Peak peak = measure_peak(device);
    const auto site = collapsing_block(device, bench_sand(), size.edge);
    const std::vector<soil::Particle> start = site->solver().particles();
    Row steps = time_steps(device, *site, size.steps);
    Row loop = native_row(device, *site, start, steps);
    loop.bench = std::string("native_loop:") + size.name;
    steps.bench = std::string("soil_collapse_no_tool:") + size.name;
    for (Row* row : {&loop, &steps}) {
      row->device = device.info().name;
      row->driver = device.info().driver;
      row->peak = peak;
      take(*row);
    }
  }
  if (!found)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "bench", only,
                           "no size of --native has this word in its name", "one of: 8k 64k 405k"});
}

NativeRatio native_ratio(const Row& loop, const Row& steps) {
  // Particle-steps; the copies of the loop together have as many threads as the steps.
  const auto work = [](const Row& row) {
    return static_cast<double>(row.particles) * static_cast<double>(row.steps);
  };
  return {work(steps) / steps.timing.best / (work(loop) / loop.timing.best),
          work(steps) / steps.timing.processor / (work(loop) / loop.timing.processor)};
}

}  // namespace navvy::bench
