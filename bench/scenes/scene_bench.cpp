// SPDX-License-Identifier: Apache-2.0
// Whole scenes with machines, control and soil, without pictures:
// `scene_bench [SECONDS [SCENE.sdf ...]]`.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "bench.h"
#include "control/step_kinds.h"
#include "core/stopwatch.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace {

using namespace navvy;

/// Runs the scene from its start for `seconds`. There is one run only, so median and spread are
/// those of that run.
void measure_scene(device::Device& device, const std::string& file, double seconds) {
  session::Session session(scene_io::load_scene(file, control::step_kinds()), device);
  const Stopwatch watch;
  while (!session.done() && session.world().time() < seconds) session.step();
  device.finish();
  bench::Row row;
  row.timing.best = row.timing.median = watch.seconds();
  row.timing.runs = 1;
  const sim::SoilCounts stats = session.world().soil().counts();
  row.bench = "scene:" + std::filesystem::path(file).stem().string() + "_" +
              std::to_string(static_cast<int>(seconds)) + "s";
  row.steps = stats.steps;
  // Mean number of particles.
  row.particles = stats.steps > 0 ? stats.particle_steps / stats.steps : 0;
  row.simulated = session.world().time();
  row.hash = session.state_hash();
  bench::print(device.info(), row);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // The trench: arrival and the first bucket.
    double seconds = 40;
    if (argc > 1) {
      char* end = nullptr;
      seconds = std::strtod(argv[1], &end);
      if (end == argv[1] || *end != '\0' || !(seconds > 0)) {
        std::fprintf(stderr,
                     "usage: scene_bench [SECONDS [SCENE.sdf...]]   one row a scene, run for so "
                     "long (40)\n");
        return 2;
      }
    }
    std::vector<std::string> files;
    for (int i = 2; i < argc; ++i) files.emplace_back(argv[i]);
    const std::string folder = navvy::source_dir() + "/scenarios/";
    if (files.empty())
      for (const char* name : {"block_collapse", "bucket_path", "trench"})
        files.push_back(folder + name + ".sdf");
    device::Device device;
    for (const std::string& file : files) measure_scene(device, file, seconds);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
