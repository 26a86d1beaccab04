// SPDX-License-Identifier: Apache-2.0
// Paths for the excavator of scenarios/drive_around_trench.sdf: `plan_bench [NAME [RUNS]]` runs the
// rows whose name contains NAME. Host only, no device.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench.h"
#include "control/step_kinds.h"
#include "control/surface.h"
#include "core/saved_state.h"
#include "core/stopwatch.h"
#include "heightfield/make_ground.h"
#include "paths.h"
#include "planner/map_path_planner.h"
#include "scene_io/loader.h"

namespace {

using namespace navvy;

/// Shapes the trench and the spoil heap that the scene's dig leaves, in simple form.
void dig(heightfield::Ground& ground, bool across) {
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const Vec2 p = ground.origin() + ground.cell() * Vec2(ix + 0.5, iy + 0.5);
      const bool trench = p.x() > 0 && p.x() < 2.4 && (across || std::abs(p.y()) < 0.525);
      if (trench) ground.take_above(ix, iy, -0.4, taken);
      const double heap = 0.8 - (p - Vec2(-0.2, 4.6)).norm() * 0.6;
      if (heap > 0)
        ground.put(ix, iy, {0, mass_units(heap * ground.cell() * ground.cell() * 1250), 1.23f, 0});
    }
}

/// Measures one row: `plans` queries with different seeds, each `runs` times.
void measure(const std::string& name, control::PathPlanner& planner,
             const control::PathQuery& asked, int plans, int runs) {
  bench::Row row;
  row.bench = name;
  row.steps = static_cast<std::uint64_t>(plans);
  std::vector<double> seconds, processor;
  StateHash hash;
  for (int run = 0; run < runs; ++run) {
    const double began = bench::processor_seconds();
    const Stopwatch watch;
    for (int plan = 0; plan < plans; ++plan) {
      control::PathQuery query = asked;
      query.seed = static_cast<std::uint32_t>(plan + 1);
      std::optional<control::Path> path = planner.plan(query);
      if (run == 0 && path) add_to_hash(hash, *path);
      if (run == 0)
        std::fprintf(stderr, "%s, seed %d: %s, %.1f m, %d cusps\n", name.c_str(), plan + 1,
                     path ? "a path" : "none", path ? path->length() : 0.0,
                     path ? path->cusps() : 0);
    }
    seconds.push_back(watch.seconds() / plans);
    processor.push_back((bench::processor_seconds() - began) / plans);
  }
  row.timing = bench::timing_of(std::move(seconds), processor);
  row.hash = hash.hex();
  bench::print_host(row);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string wanted = argc > 1 ? argv[1] : "";
    const int runs = argc > 2 ? std::atoi(argv[2]) : 3;
    if (runs < 1 || argc > 3) {
      std::fprintf(stderr,
                   "usage: plan_bench [NAME [RUNS]]   a row a question: milliseconds a plan, mean "
                   "of five seeds\n");
      return 2;
    }
    if (!planner::path_planners()) {
      std::fprintf(stderr,
                   "plan_bench: no OMPL in this build; install libompl-dev, build with "
                   "-DNAVVY_WITH_OMPL=ON\n");
      return 2;
    }
    const scene::Scene scene = scene_io::load_scene(
        navvy::source_dir() + "/scenarios/drive_around_trench.sdf", control::step_kinds());
    control::PathQuery asked;
    asked.start = {Vec2(-6, 0), 0};
    asked.goal = {Vec2(10, 0), 0};
    for (const auto& [name, dug, across] :
         {std::tuple{"plan:open", false, false}, std::tuple{"plan:round_trench", true, false},
          std::tuple{"plan:no_way", true, true}}) {
      if (std::string(name).find(wanted) == std::string::npos) continue;
      heightfield::Ground ground = heightfield::make_ground(scene);
      if (dug) dig(ground, across);
      const auto planner = planner::path_planners()(scene.machines.at(0).machine);
      planner->look(control::GroundSurfaceView(ground));
      measure(name, *planner, asked, 5, runs);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plan_bench: %s\n", error.what());
    return 1;
  }
}
