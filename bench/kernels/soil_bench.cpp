// SPDX-License-Identifier: Apache-2.0
// Whole steps of the particle soil: a collapsing block (including re-binning), and a load held in a
// bucket.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "bench.h"
#include "core/saved_state.h"
#include "soil/rig.h"

namespace {

using namespace navvy;

/// Bytes of state, tiles and velocities moved per particle in one unfused step at 8 particles per
/// cell (kernels/soil).
constexpr double kBytesPerParticle = (26 + 9 + 4 + 16) * 4 + 2 * 16 * 516 / 512.0 + 2 * 16 / 8.0;

bool profile = false;
std::string only;

/// Prints the times of the host's stages and of the kernels, each from a run of its own: the
/// kernels' clock slows the host down.
template <class Work>
void print_profile(soil::rig::Rig& rig, const std::vector<char>& start, const Work& work,
                   double particle_steps) {
  device::Device& device = soil::rig::Rig::device();
  load_saved(start, rig.solver());
  const auto before = rig.solver().stage_times();
  work();
  for (const auto& [stage, seconds] : rig.solver().stage_times()) {
    double took = seconds;
    for (const auto& [name, earlier] : before) took -= name == stage ? earlier : 0;
    std::printf("# stage  %-18s %26.3f ms %7.2f ns a particle-step\n", stage.c_str(), took * 1e3,
                took * 1e9 / particle_steps);
  }
  load_saved(start, rig.solver());
  device.set_profile(true);
  device.clear_profile();
  work();
  for (const device::KernelTime& time : device.profile())
    std::printf("# kernel %-18s %6llu launches %9.3f ms %7.2f ns a particle-step\n",
                time.name.c_str(), static_cast<unsigned long long>(time.launches),
                time.seconds * 1e3, time.seconds * 1e9 / particle_steps);
  device.set_profile(false);
}

/// Runs `steps` steps from the same snapshot and prints a row; tools keep their velocity.
void bench_row(const std::string& name, soil::rig::Rig& rig, int steps,
               std::vector<soil::ToolMotion> motions) {
  const std::vector<char> start = saved(rig.solver());
  double fastest = 0;
  for (const soil::ToolMotion& motion : motions) fastest = std::max(fastest, motion.v_WT.norm());
  const double dt = rig.solver().step_limit(fastest);
  std::vector<soil::ToolImpulse> impulses(motions.size());
  const auto work = [&] {
    std::vector<soil::ToolMotion> now = motions;
    for (int i = 0; i < steps; ++i) {
      rig.solver().step(dt, now, impulses);
      for (soil::ToolMotion& motion : now) motion.X_WT.translation() += dt * motion.v_WT;
    }
  };
  bench::Row row;
  row.bench = name;
  row.particles = rig.solver().particles().size();
  row.steps = static_cast<std::uint64_t>(steps);
  row.simulated = steps * dt;
  row.bytes_per_particle = kBytesPerParticle;
  row.timing = bench::measure(
      soil::rig::Rig::device(), [&] { load_saved(start, rig.solver()); }, work, 3);
  row.hash = hash_of(rig.solver()).hex();
  bench::print(soil::rig::Rig::device().info(), row);
  if (profile) print_profile(rig, start, work, static_cast<double>(row.particles) * steps);
}

void collapse(double edge, int steps) {
  soil::rig::Rig rig({soil::rig::sand()});
  rig.solver().insert(rig.fill({Vec3(6, 6, 0), Vec3(6 + edge, 6 + edge, edge)}, true));
  // Measure soil that is in motion.
  rig.run(0.1);
  bench_row("soil_collapse_no_tool", rig, steps, {});
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
      for (double x = -0.46; x < 0.47; x += 0.05)
        load.push_back(rig.particle(X * Vec3(x, y, z), 1.25e-4));
  rig.solver().insert(load);
  bench_row("soil_held_bucket", rig, steps, {motion});
}

/// A tilted bucket with its cutting edge in a bed of 8000 particles per cubic metre: the cost of a
/// trench.
void dig(const std::string& name, const soil::rig::SiteBox& bed, int steps) {
  soil::rig::Rig rig({soil::rig::sand(35)}, bed);
  rig.solver().insert(rig.fill(bed, true));
  soil::ToolMotion motion;
  motion.tool = rig.solver().add_tool(soil::rig::open_box(0.8, 0.8, 0.6));
  motion.v_WT = Vec3(0.5, 0, 0);
  motion.X_WT = make_pose(7.01, 7.02, 0.1, 0, radians(110), 0);
  bench_row(name, rig, steps, {motion});
}

/// The same dig in beds of several sizes, in the caller's thread and in worker threads. Where both
/// are equally fast lies the number of particles in src/soil/particles/schedule.cpp.
void threads() {
  for (const Vec3& size : {Vec3(1.6, 1, 0.3), Vec3(1.6, 1, 0.6), Vec3(2, 1.2, 0.6),
                           Vec3(2, 1.7, 0.6), Vec3(2.5, 2, 0.6), Vec3(3, 2.4, 0.6)}) {
    const soil::rig::SiteBox bed = {Vec3(6.4, 7 - size.y() / 2, -size.z()),
                                    Vec3(6.4 + size.x(), 7 + size.y() / 2, 0)};
    for (const char* below : {"1e9", "0"}) {
      ::setenv("NAVVY_FEW_PARTICLES", below, 1);
      dig(*below == '0' ? "soil_dig_workers" : "soil_dig_caller", bed, 300);
    }
    ::unsetenv("NAVVY_FEW_PARTICLES");
  }
}

/// Runs the cases whose name contains the given word, or all cases without one.
template <class Case>
void run(const std::string& name, const Case& work) {
  if (name.find(only) != std::string::npos) work();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i)
      (std::string(argv[i]) == "--profile" ? profile = true : (only = argv[i], true));
    run("dig", [] { dig("soil_dig", {Vec3(6, 6, -0.6), Vec3(9, 8, 0)}, 100); });
    run("threads", threads);
    run("held_bucket", [] { held_bucket(200); });
    run("collapse_8k", [] { collapse(1.0, 200); });
    run("collapse_50k", [] { collapse(1.85, 100); });
    run("collapse_64k", [] { collapse(2.0, 100); });
    run("collapse_512k", [] { collapse(4.0, 20); });
    // Takes a gigabyte of memory and several minutes, so it runs only on request.
    if (only == "collapse_2m") collapse(6.3, 5);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
