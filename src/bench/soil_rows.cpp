// SPDX-License-Identifier: Apache-2.0
#include "bench/soil_rows.h"

#include <algorithm>
#include <cmath>

#include "bench/measure.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/soils.h"

namespace navvy::bench {
namespace {

using lab::open_box;
using lab::Site;
using lab::SiteBox;

/// Bytes of state, tiles and velocities that a particle moves in one unfused step at 8 particles
/// per cell (kernels/soil).
constexpr double kBytesPerParticle = (26 + 9 + 4 + 16) * 4 + 2 * 16 * 516 / 512.0 + 2 * 16 / 8.0;
/// Operations of scatter (440), gather (500), law and weights (about 360) for a particle, counted
/// from the lines of kernels/soil. The share of the grid is small and left out.
constexpr double kFlopsPerParticle = 1300;
// Few, as the largest cases take long on two cores; the spread shows when that was too few.
constexpr int kRuns = 3;

// Dry sand of the validation cases, so that a bench measures what the tests check.
scene::Soil sand() { return lab::clean_sand(35); }

/// Times `steps` steps from the site's present state; tools keep their speed.
Row time_steps(device::Device& device, Site& site, int steps,
               std::vector<soil::ToolMotion> motions = {}) {
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
    const std::uint64_t before = site.solver().stats().particle_steps;
    for (int i = 0; i < steps; ++i) {
      site.solver().step(dt, now, impulses);
      for (soil::ToolMotion& motion : now) motion.X_WT.translation() += dt * motion.v_WT;
    }
    // Their mean: ground may become active.
    row.particles = (site.solver().stats().particle_steps - before) / row.steps;
  };
  row.timing = measure(device, restore, work, kRuns);
  // In separate runs, because the profile slows a run down.
  row.kernels = kernel_seconds(device, restore, work);
  // From the last run. All runs begin and end alike, so any of them will do. A row with another
  // hash simulated something else, and its time is not compared.
  row.hash = hash_of(site.solver()).hex();
  return row;
}

/// A block on level ground that collapses, including re-binning.
Row collapse(device::Device& device, double edge, int steps) {
  lab::SiteOptions options;
  options.size = 20;
  Site site(device, {sand()}, 0.1, options);
  // Particles at half a cell: 8 per cell, so 8000 in a block of 1 m.
  std::vector<soil::Particle> block =
      site.fill({Vec3(-edge / 2, -edge / 2, 0), Vec3(edge / 2, edge / 2, edge)});
  site.rest(block, edge);
  site.solver().insert(block);
  // The soil is then in motion.
  site.run(0.1);
  return time_steps(device, site, steps);
}

/// Sand that uses every option of the law: dilatancy, mu(I), compaction (LAW_EXTENDED).
scene::Soil every_option() {
  scene::Soil soil = sand();
  soil.swell = 1.13;
  soil.dilatancy_angle = radians(8);
  soil.fast_friction_angle = radians(40);
  soil.compaction_pressure = 50e3;
  return soil;
}

/// A load at rest in a bucket: the cost of the shell without motion.
Row held_bucket(device::Device& device, int steps) {
  Site site(device, {sand()}, 0.1);
  soil::ToolMotion motion;
  motion.tool = site.solver().add_tool(open_box(1.0, 0.8, 0.6));
  motion.X_WT = make_pose(0.03, 0.02, 1.5, 0, radians(15), 0);
  std::vector<soil::Particle> load;
  // At half a cell, as insertion makes them, and clear of the shell's sides at the start.
  for (double z = 0.04; z < 0.45; z += 0.05)
    for (double y = -0.36; y < 0.37; y += 0.05)
      for (double x = -0.46; x < 0.47; x += 0.05)
        load.push_back(site.particle(motion.X_WT * Vec3(x, y, z), 1.25e-4));
  site.solver().insert(load);
  return time_steps(device, site, steps, {motion});
}

/// A tilted bucket with its cutting edge in a bed of `length` x `width` x 0.6 m: the cost of a
/// trench.
Row dig(device::Device& device, double length, double width, int steps,
        const scene::Soil& what = sand()) {
  const SiteBox bed = {Vec3(0, -width / 2, -0.6), Vec3(length, width / 2, 0)};
  lab::SiteOptions options;
  // Larger than the bed, so that no soil reaches the site's edge and the count stays.
  options.size = std::max(20.0, 2 * length + 4);
  options.surface = lab::pit(bed);
  Site site(device, {what}, 0.1, options);
  std::vector<soil::Particle> soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);
  soil::ToolMotion motion;
  motion.tool = site.solver().add_tool(open_box(0.8, 0.8, 0.6));
  motion.v_WT = Vec3(0.5, 0, 0);
  // Tilted as for digging; the odd numbers keep it off the edges of cells.
  motion.X_WT = make_pose(1.01, 0.02, 0.1, 0, radians(110), 0);
  return time_steps(device, site, steps, {motion});
}

/// A bucket drawn through ground that becomes active before it and rests behind it, on a square
/// site of edge `size` [m]. The cost must follow the active soil, not the site.
Row site_dig(device::Device& device, double size, int steps) {
  lab::SiteOptions options;
  options.size = size;
  options.exchange = true;
  Site site(device, {sand()}, 0.1, options);
  soil::ToolMotion motion;
  motion.tool = site.solver().add_tool(open_box(0.8, 0.8, 0.6));
  motion.v_WT = Vec3(0.5, 0, 0);
  motion.X_WT = make_pose(0.01, 0.02, 0.1, 0, radians(110), 0);
  const double dt = site.solver().step_limit(0.5);
  std::vector<soil::ToolImpulse> impulse(1);
  // Until the zone before the tool is active: the first touch is not a steady cost.
  for (int i = 0; i < 20; ++i) {
    site.solver().step(dt, std::span(&motion, 1), impulse);
    motion.X_WT.translation() += dt * motion.v_WT;
  }
  Row row = time_steps(device, site, steps, {motion});
  row.site = size;
  return row;
}

// Recorded results are compared by these names, so they stay. The number behind the colon is that
// of the particles, rounded, or the site's area.
std::vector<SoilCase> make_cases() {
  using Device = device::Device;
  return {
      {"soil_held_bucket", "a load at rest in a bucket", true,
       [](Device& d) { return held_bucket(d, 100); }},
      {"soil_dig:29k", "a bucket drawn through a bed", true,
       [](Device& d) { return dig(d, 3, 2, 100); }},
      {"soil_dig:96k", "the same in a longer bed", false,
       [](Device& d) { return dig(d, 10, 2, 50); }},
      {"soil_dig:403k", "the same in a wide bed", false,
       [](Device& d) { return dig(d, 12, 7, 20); }},
      {"soil_dig_extended_law:403k", "the same with dilatancy, mu(I) and compaction", false,
       [](Device& d) { return dig(d, 12, 7, 20, every_option()); }},
      {"soil_collapse_no_tool:8k", "a block of 1 m falling apart", true,
       [](Device& d) { return collapse(d, 1.0, 100); }},
      {"soil_collapse_no_tool:27k", "1.5 m", false,
       [](Device& d) { return collapse(d, 1.5, 100); }},
      {"soil_collapse_no_tool:50k", "1.85 m", false,
       [](Device& d) { return collapse(d, 1.85, 50); }},
      {"soil_collapse_no_tool:64k", "2 m", true, [](Device& d) { return collapse(d, 2.0, 50); }},
      {"soil_collapse_no_tool:216k", "3 m", false, [](Device& d) { return collapse(d, 3.0, 20); }},
      {"soil_collapse_no_tool:512k", "4 m", false, [](Device& d) { return collapse(d, 4.0, 20); }},
      {"soil_collapse_no_tool:1953k", "6.25 m", false,
       [](Device& d) { return collapse(d, 6.25, 5); }},
      {"site_dig:0.01km2", "a dig on ground that becomes active", true,
       [](Device& d) { return site_dig(d, 100, 100); }},
      {"site_dig:0.1km2", "the same on a larger site", false,
       [](Device& d) { return site_dig(d, 316.2, 100); }},
      {"site_dig:1km2", "the same on a larger site", false,
       [](Device& d) { return site_dig(d, 1000, 100); }},
  };
}

}  // namespace

const std::vector<SoilCase>& soil_cases() {
  static const std::vector<SoilCase> cases = make_cases();
  return cases;
}

void run_soil_cases(device::Device& device, const std::string& only, bool quick,
                    const std::function<void(const Row&)>& take) {
  std::vector<const SoilCase*> wanted;
  std::string names;
  for (const SoilCase& c : soil_cases()) {
    names += " " + c.name;
    // Part of the name is enough, so one word selects a family.
    if (c.name.find(only) != std::string::npos && (!quick || c.quick)) wanted.push_back(&c);
  }
  if (wanted.empty())
    throw InputError(Fault{Fault::Severity::kError, "", 0, "bench", only,
                           "no case has this word in its name", "one of:" + names});
  for (const SoilCase* c : wanted) {
    // Beside its row, so that other load on the machine affects both alike.
    const Peak peak = measure_peak(device);
    Row row = c->run(device);
    row.bench = c->name;
    row.device = device.info().name;
    row.driver = device.info().driver;
    row.peak = peak;
    take(row);
  }
}

}  // namespace navvy::bench
