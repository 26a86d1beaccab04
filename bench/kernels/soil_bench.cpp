// SPDX-License-Identifier: Apache-2.0
// Whole steps of the particle soil: a block that collapses (re-binning included), and a load held in a bucket.
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "bench.h"
#include "core/hash.h"
#include "soil/rig.h"

namespace {

using namespace navvy;

/// Bytes of state, tiles and velocities a particle moves in one unfused step at 8 particles a cell (kernels/soil).
constexpr double kBytesPerParticle = (26 + 9 + 4 + 16) * 4 + 2 * 16 * 516 / 512.0 + 2 * 16 / 8.0;

/// Runs `steps` steps from the same snapshot and prints a row.
void bench_row(const std::string& name, soil::rig::Rig& rig, int steps, std::span<const soil::ToolMotion> motions) {
  StateWriter writer;
  rig.solver().save(writer);
  const double dt = rig.solver().step_limit(0);
  std::vector<soil::ToolImpulse> impulses(motions.size());
  std::string hash;
  bench::Row row;
  row.bench = name;
  row.particles = rig.solver().particles().size();
  row.steps = static_cast<std::uint64_t>(steps);
  row.simulated = steps * dt;
  row.bytes_per_particle = kBytesPerParticle;
  row.timing = bench::measure(
      soil::rig::Rig::device(),
      [&] {
        StateReader reader(writer.bytes());
        rig.solver().load(reader);
      },
      [&] {
        for (int i = 0; i < steps; ++i) rig.solver().step(dt, motions, impulses);
      },
      3);
  StateHash state;
  rig.solver().hash(state);
  row.hash = state.hex();
  bench::print(soil::rig::Rig::device().info(), row);
}

void collapse(double edge, int steps) {
  soil::rig::Rig rig({soil::rig::sand()});
  rig.solver().insert(rig.fill({Vec3(6, 6, 0), Vec3(6 + edge, 6 + edge, edge)}, true));
  rig.run(0.1);  // in motion
  bench_row("soil_collapse", rig, steps, {});
}

void held_bucket(int steps) {
  soil::rig::Rig rig({soil::rig::sand(35)});
  const Pose X = make_pose(10.03, 10.02, 1.5, 0, radians(15), 0);
  soil::ToolMotion motion;
  motion.tool = rig.solver().add_tool(soil::rig::open_box(1.0, 0.8, 0.6));
  motion.X_WT = X;
  std::vector<soil::Particle> load;
  for (double z = 0.04; z < 0.45; z += 0.05)
    for (double y = -0.36; y < 0.37; y += 0.05)
      for (double x = -0.46; x < 0.47; x += 0.05) load.push_back(rig.particle(X * Vec3(x, y, z), 1.25e-4));
  rig.solver().insert(load);
  bench_row("soil_held_bucket", rig, steps, std::span(&motion, 1));
}

}  // namespace

int main() {
  try {
    collapse(1.0, 200);
    collapse(2.0, 100);
    collapse(4.0, 20);
    held_bucket(200);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
