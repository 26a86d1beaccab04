// SPDX-License-Identifier: Apache-2.0
// Small operations that every step uses, under Google Benchmark: copies, launches, reads, height
// queries.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/saved_state.h"
#include "device/buffer.h"
#include "device/device.h"
#include "device/kernel_program.h"
#include "heightfield/change_follower.h"
#include "heightfield/layered_ground.h"

namespace {

using namespace navvy;

device::Device& shared_device() {
  static device::Device device;
  return device;
}

void device_copy(benchmark::State& state) {
  device::Device& device = shared_device();
  const device::KernelProgram program = device::KernelProgram::from_text(
      device, "copy",
      "kernel void copy(global const float4* from, global float4* to) { "
      "to[get_global_id(0)] = from[get_global_id(0)]; }");
  const auto bytes = static_cast<std::size_t>(state.range(0));
  device::Buffer<float> from(device, bytes / 4), to(device, bytes / 4);
  from.fill(1);
  to.fill(0);
  device::Kernel copy(program, "copy");
  copy.args(from, to);
  for (auto _ : state) {
    copy.enqueue(bytes / 16, 64);
    device.finish();
  }
  state.SetBytesProcessed(2 * state.range(0) * static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(device_copy)->RangeMultiplier(16)->Range(1 << 16, 1 << 28)->UseRealTime();

void kernel_launch(benchmark::State& state) {
  device::Device& device = shared_device();
  const device::KernelProgram program = device::KernelProgram::from_text(
      device, "nothing", "kernel void nothing(global int* x) { if (x[0] == 1) x[1] = 2; }");
  device::Buffer<int> x(device, 2);
  x.fill(0);
  device::Kernel nothing(program, "nothing");
  nothing.args(x);
  for (auto _ : state) nothing.enqueue(1);
  device.finish();
}
BENCHMARK(kernel_launch)->UseRealTime();

void launch_and_wait(benchmark::State& state) {
  device::Device& device = shared_device();
  const device::KernelProgram program = device::KernelProgram::from_text(
      device, "nothing", "kernel void nothing(global int* x) { if (x[0] == 1) x[1] = 2; }");
  device::Buffer<int> x(device, 2);
  x.fill(0);
  device::Kernel nothing(program, "nothing");
  nothing.args(x);
  for (auto _ : state) {
    nothing.enqueue(1);
    device.finish();
  }
}
BENCHMARK(launch_and_wait)->UseRealTime();

heightfield::Ground make_ground(int columns) {
  heightfield::Ground::Setup setup;
  setup.nx = setup.ny = columns;
  setup.datum = -4;
  setup.soils.resize(1);
  setup.soils[0].name = "soil";
  setup.layers = {{"soil", 4}};
  setup.surface = [](int ix, int iy) { return 0.2 * std::sin(0.1 * ix) * std::cos(0.07 * iy); };
  return heightfield::Ground(setup);
}

/// Measures a height between columns of untouched ground; the argument is the edge length of the
/// site in columns.
void ground_sample_untouched(benchmark::State& state) {
  const heightfield::Ground ground = make_ground(static_cast<int>(state.range(0)));
  double x = 1.7, sum = 0;
  for (auto _ : state) {
    x = x < 8 ? x + 0.031 : 1.7;
    sum += ground.sample(x, 5.3);
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(ground_sample_untouched)->Arg(1000)->Arg(10000);

/// Measures the height of a column of dug ground.
void ground_height_touched(benchmark::State& state) {
  heightfield::Ground ground = make_ground(1000);
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = 100; iy < 200; ++iy)
    for (int ix = 100; ix < 200; ++ix)
      ground.take_above(ix, iy, ground.height(ix, iy) - 0.1, taken);
  int ix = 100;
  double sum = 0;
  for (auto _ : state) {
    ix = ix < 199 ? ix + 1 : 100;
    sum += ground.height(ix, 150);
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(ground_height_touched);

/// Lowers a hundred columns of a 1 km2 site a little, `apart` columns from each other.
void dig_hundred(heightfield::Ground& ground, int apart) {
  std::vector<heightfield::SoilLayer> taken;
  for (int i = 0; i < 100; ++i) {
    const int ix = 3000 + apart * (i % 10), iy = 3000 + apart * (i / 10);
    ground.take_above(ix, iy, ground.height(ix, iy) - 0.001, taken);
  }
}

/// Measures a view after a step in which 100 columns of 1 km2 changed; the argument is their
/// distance from each other.
void terrain_view(benchmark::State& state) {
  heightfield::Ground ground = make_ground(10000);
  for (auto _ : state) {
    state.PauseTiming();
    dig_hundred(ground, static_cast<int>(state.range(0)));
    state.ResumeTiming();
    benchmark::DoNotOptimize(ground.view());
  }
}
BENCHMARK(terrain_view)->Arg(1)->Arg(40)->Iterations(2000);

/// Measures the same step as a whole: digging, with the copies of shared tiles, a view, and the
/// list of changes.
void terrain_dig_view_and_follow(benchmark::State& state) {
  heightfield::Ground ground = make_ground(10000);
  heightfield::ChangeFollower follower;
  follower.take(ground.view());
  for (auto _ : state) {
    dig_hundred(ground, static_cast<int>(state.range(0)));
    benchmark::DoNotOptimize(follower.take(ground.view()));
  }
}
BENCHMARK(terrain_dig_view_and_follow)
    ->Arg(1)
    ->Arg(40)
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);

/// Measures taking soil off a column and putting it back.
void ground_take_and_put(benchmark::State& state) {
  heightfield::Ground ground = make_ground(1000);
  std::vector<heightfield::SoilLayer> taken;
  int ix = 100;
  for (auto _ : state) {
    ix = ix < 164 ? ix + 1 : 100;
    taken.clear();
    ground.take_above(ix, 120, ground.height(ix, 120) - 0.1, taken);
    for (const heightfield::SoilLayer& layer : taken) ground.put(ix, 120, layer);
  }
}
BENCHMARK(ground_take_and_put);

void ground_save(benchmark::State& state) {
  heightfield::Ground ground = make_ground(1000);
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = 0; iy < 128; ++iy)
    for (int ix = 0; ix < 128; ++ix) ground.take_above(ix, iy, ground.height(ix, iy) - 0.1, taken);
  for (auto _ : state) {
    benchmark::DoNotOptimize(saved(ground).data());
  }
}
BENCHMARK(ground_save)->Unit(benchmark::kMicrosecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const device::DeviceInfo& info = shared_device().info();
  benchmark::AddCustomContext("device", info.name);
  benchmark::AddCustomContext("driver", info.driver);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
