// SPDX-License-Identifier: Apache-2.0
#include "bench/soil_steps.h"

#include <algorithm>

#include "bench/measure.h"
#include "core/saved_state.h"
#include "device/device.h"

namespace navvy::bench {
namespace {

/// Bytes of state, tiles and velocities that a particle moves in one unfused step at 8 particles
/// per cell (kernels/soil).
constexpr double kBytesPerParticle = (26 + 9 + 4 + 16) * 4 + 2 * 16 * 516 / 512.0 + 2 * 16 / 8.0;
/// Operations of scatter (440), gather (500), law and weights (about 360) for a particle, counted
/// from the lines of kernels/soil. The share of the grid is small and left out.
constexpr double kFlopsPerParticle = 1300;
// Few, as the largest cases take long on two cores; the spread shows when that was too few.
constexpr int kRuns = 3;

}  // namespace

Row time_steps(device::Device& device, lab::Site& site, int steps,
               const std::vector<soil::ToolMotion>& motions) {
  // One saved state for all runs, so that each starts bit-identical.
  const std::vector<char> ground = saved(site.ground()), soil = saved(site.solver());
  // The step that the stability limit allows for the fastest tool, computed once: runs must not
  // differ in it.
  double fastest = 0;
  for (const soil::ToolMotion& motion : motions) fastest = std::max(fastest, motion.v_WT.norm());
  const double dt = site.solver().step_limit(fastest);
  std::vector<soil::ToolImpulse> impulses(motions.size());
  Row row;
  row.steps = static_cast<std::uint64_t>(steps);
  row.simulated = steps * dt;
  row.bytes_per_particle = kBytesPerParticle;
  row.flops_per_particle = kFlopsPerParticle;
  const auto restore = [&] {
    load_saved(ground, site.ground());
    load_saved(soil, site.solver());
  };
  const auto work = [&] {
    // A copy per run, as the tools move.
    std::vector<soil::ToolMotion> now = motions;
    const soil::SolverStats& stats = site.solver().stats();
    const std::uint64_t before = stats.particle_steps;
    double blocks = 0, nodes = 0;
    for (int i = 0; i < steps; ++i) {
      site.solver().step(dt, now, impulses);
      for (soil::ToolMotion& motion : now) motion.X_WT.translation() += dt * motion.v_WT;
      blocks += stats.active_blocks;
      nodes += stats.near_nodes;
    }
    // Their means: ground may become active.
    row.particles = (stats.particle_steps - before) / row.steps;
    row.active_blocks = blocks / steps;
    row.contact_nodes = nodes / steps;
  };
  row.timing = measure(device, restore, work, kRuns);
  // In separate runs, because the profile slows a run down.
  row.kernels = kernel_seconds(device, restore, work);
  // From the last run. All runs begin and end alike, so any of them will do. A row with another
  // hash simulated something else, and its time is not compared.
  row.hash = hash_of(site.solver()).hex();
  return row;
}

std::unique_ptr<lab::Site> collapsing_block(device::Device& device, const scene::Soil& soil,
                                            double edge) {
  lab::SiteOptions options;
  options.size = 20;
  auto site = std::make_unique<lab::Site>(device, std::vector<scene::Soil>{soil}, 0.1, options);
  // Particles at half a cell: 8 per cell, so 8000 in a block of 1 m.
  std::vector<soil::Particle> block =
      site->fill({Vec3(-edge / 2, -edge / 2, 0), Vec3(edge / 2, edge / 2, edge)});
  site->rest(block, edge);
  site->solver().insert(block);
  // The soil is then in motion.
  site->run(0.1);
  return site;
}

}  // namespace navvy::bench
