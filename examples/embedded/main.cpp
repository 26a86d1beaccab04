// SPDX-License-Identifier: Apache-2.0
// Runs a scene from C++: records it, drives a joint, queries heights, and resets.
#include <cstdio>
#include <exception>
#include <string>

#include "control/step_kinds.h"
#include "run/simulation.h"
#include "scene_io/loader.h"

int main(int argc, char** argv) {
  try {
    navvy::run::SimulationOptions options;
    options.folder = argc > 1 ? argv[1] : "out/embedded";
    options.duration = 0.5;
    options.pictures = false;
    const std::string file = navvy::scene_io::find_data("scenarios/bucket_path.sdf");
    navvy::run::Simulation simulation(
        navvy::scene_io::load_scene(file, navvy::control::step_kinds()), options);

    // Record a run in which the bucket is pressed into the ground at 1 m/s.
    simulation.set("bucket/slide_z/velocity", -1.0);
    const navvy::run::RunEnd end = simulation.run_to_end();
    const double dug = simulation.heights().sample(-1.6, 0.0);

    // Reset: the ground is untouched again, and nothing is recorded.
    simulation.reset();
    const double fresh = simulation.heights().sample(-1.6, 0.0);
    std::printf("%s after %.2f s: height %.3f m; after the reset %.3f m\n",
                navvy::run::name_of(end.reason), end.time, dug, fresh);
    return dug != fresh ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
