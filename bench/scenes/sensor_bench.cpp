// SPDX-License-Identifier: Apache-2.0
// Beams of sensors: `sensor_bench [NAME [RUNS]]` runs the rows whose name contains NAME. An
// excavator and a dumper with about 15 000 particles of soil in its bed stand between boxes; a
// scanner looks at all of them. `bullet` rows send the same beams through Bullet. `trench` digs for
// some seconds and measures what a scan at 50 Hz adds; `step` are the steps between two scans.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bench.h"
#include "bullet_rays.h"
#include "control/step_kinds.h"
#include "core/hash.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "sensor/pixels.h"
#include "sensor/ray_scene.h"
#include "session/session.h"
#include "sim/visible_soil.h"
#include "sim/world.h"

namespace {

using namespace navvy;

const Vec3 kEye(-5, 0, 1.8);  // of the scanner in W [m]

std::string scene_text() {
  std::string boxes;
  for (int i = 0; i < 10; ++i)
    boxes += "<model name=\"box" + std::to_string(i) + "\"><static>true</static><pose>" +
             std::to_string(4 + i % 5) + " " + std::to_string(2 * i - 9) +
             " 0 0 0 0.3</pose><link name=\"l\"><visual name=\"v\"><geometry><box><size>0.8 0.8 2"
             "</size></box></geometry></visual></link></model>";
  return R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="scan"><navvy:soil ref="loam"/>
<navvy:ground><size_m>40 40</size_m><depth_m>1</depth_m></navvy:ground>
<include><uri>model://ew180</uri><name>digger</name><pose>-1 6 0 0 0 0</pose></include>
<include><uri>model://dumper</uri><name>dumper</name><pose>0 0 0 0 0 0</pose>
<navvy:load><soil>loam</soil><mass_kg>2400</mass_kg></navvy:load></include>)" +
         boxes + "</world></sdf>";
}

/// Returns the directions of a fan of `n` beams over 180 degrees, in `rings` rings over 30 degrees
/// that look down a little.
std::vector<Vec3> fan(int n, int rings) {
  std::vector<Vec3> out;
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < n; ++i) {
      const double a = -0.5 * kPi + kPi * i / (n - 1);
      const double up = rings > 1 ? radians(-20 + 30.0 * ring / (rings - 1)) : radians(-3);
      out.emplace_back(std::cos(up) * std::cos(a), std::cos(up) * std::sin(a), std::sin(up));
    }
  return out;
}

std::vector<Vec3> picture(int width, int height) {
  const sensor::Pixels pixels(width, height, radians(60));
  const Mat3 down = make_pose(0, 0, 0, 0, 0.2, 0).linear();
  std::vector<Vec3> out;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      out.push_back(down * pixels.ray(column + 0.5, row + 0.5).normalized());
  return out;
}

/// Returns the distance along a beam; a negative number for none.
using Beam = std::function<double(const Vec3& direction_W)>;

/// Measures one row: `prepare` and then all beams, in each run.
void measure(const std::string& name, std::size_t particles, const Beam& beam,
             const std::vector<Vec3>& beams, int runs, const std::function<void()>& prepare) {
  bench::Row row;
  row.bench = name;
  row.steps = beams.size();
  row.particles = particles;
  std::vector<double> seconds, processor;
  StateHash hash;
  for (int run = 0; run <= runs; ++run) {
    const double began = bench::processor_seconds();
    const Stopwatch watch;
    prepare();
    double sum = 0;
    for (const Vec3& d : beams) sum += std::max(0.0, beam(d));
    // The first run warms up.
    if (run == 0) {
      hash.value(sum);
      continue;
    }
    seconds.push_back(watch.seconds());
    processor.push_back(bench::processor_seconds() - began);
  }
  row.timing = bench::timing_of(std::move(seconds), processor);
  row.hash = hash.hex();
  bench::print_host(row);
}

/// Digs the trench from 8 s on, and measures in each fiftieth of a second the steps and then a scan
/// of 361 beams from behind the cabin.
void measure_trench(device::Device& device) {
  session::Session session(
      scene_io::load_scene(navvy::source_dir() + "/scenarios/trench.sdf", control::step_kinds()),
      device);
  const sim::World& world = session.world();
  while (world.time() < 8) session.step();
  sensor::RayScene scene(world);
  scene.update();
  const std::vector<Vec3> beams = fan(361, 1);
  std::vector<double> steps, steps_processor, scans, scans_processor;
  const auto lap = [](std::vector<double>& seconds, std::vector<double>& processor,
                      const std::function<void()>& work) {
    const double began = bench::processor_seconds();
    const Stopwatch watch;
    work();
    seconds.push_back(watch.seconds());
    processor.push_back(bench::processor_seconds() - began);
  };
  double sum = 0;
  while (world.time() < 14) {
    const double until = world.time() + 0.02 - 0.5 * world.dt();
    lap(steps, steps_processor, [&] {
      while (world.time() < until) session.step();
    });
    const Vec3 eye = world.machines().at(0).link(0).pose().translation() + Vec3(0, 0, 2.5);
    lap(scans, scans_processor, [&] {
      scene.update();
      for (const Vec3& d : beams)
        if (const auto hit = scene.first_hit(eye, d, 20)) sum += hit->distance;
    });
  }
  const auto total = [](const std::vector<double>& all) {
    return std::accumulate(all.begin(), all.end(), 0.0);
  };
  const double share = total(scans_processor) / total(steps_processor);
  const auto put = [&](const char* name, std::vector<double> seconds,
                       const std::vector<double>& processor) {
    bench::Row row;
    row.bench = name;
    row.steps = seconds.size();
    row.particles = world.soil().counts().particles;
    row.timing = bench::timing_of(std::move(seconds), processor);
    bench::print_host(row);
  };
  put("scan:trench_step", std::move(steps), steps_processor);
  put("scan:trench", std::move(scans), scans_processor);
  std::fprintf(stderr, "trench: scans at 50 Hz take %.2f %% of the processor time of its steps\n",
               1e2 * share);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string wanted = argc > 1 ? argv[1] : "";
    const int runs = argc > 2 ? std::atoi(argv[2]) : 20;
    if (runs < 1 || argc > 3) {
      std::fprintf(stderr, "usage: sensor_bench [NAME [RUNS]]   a row a scan: milliseconds\n");
      return 2;
    }
    device::Device device;
    sim::World world(
        scene_io::load_scene_from_string(scene_text(), "scan.sdf", control::step_kinds()), device);
    for (int i = 0; i < 10; ++i) world.step();
    sensor::RayScene scene(world);
    scene.update();
    sim::VisibleSoil soil(world);
    soil.update();
    bench::BulletRays bullet(world, soil);
    const auto nothing = [] {};
    const auto renew = [&] {
      scene.forget();
      scene.update();
    };
    const Beam ours = [&](const Vec3& d) {
      const auto hit = scene.first_hit(kEye, d, 20);
      return hit ? hit->distance : -1;
    };
    const Beam bullets = [&](const Vec3& d) { return bullet.first_hit(kEye, d, 20); };
    const auto row = [&](const std::string& name, const std::vector<Vec3>& beams, const Beam& beam,
                         const std::function<void()>& prepare) {
      if (name.find(wanted) != std::string::npos)
        measure(name, world.soil().counts().particles, beam, beams, runs, prepare);
    };
    row("scan:scene", {}, ours, renew);
    row("scan:361", fan(361, 1), ours, nothing);
    row("scan:361_with_scene", fan(361, 1), ours, renew);
    row("scan:128x1024", fan(1024, 128), ours, nothing);
    row("scan:depth_640x480", picture(640, 480), ours, nothing);
    row("scan:bullet_scene", {}, bullets, [&] { bullet.update(); });
    row("scan:bullet_361", fan(361, 1), bullets, nothing);
    row("scan:bullet_128x1024", fan(1024, 128), bullets, nothing);
    row("scan:bullet_depth_640x480", picture(640, 480), bullets, nothing);
    if (std::string("scan:trench").find(wanted) != std::string::npos) measure_trench(device);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sensor_bench: %s\n", error.what());
    return 1;
  }
}
