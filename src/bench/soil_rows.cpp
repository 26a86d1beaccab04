// SPDX-License-Identifier: Apache-2.0
#include "bench/soil_rows.h"

#include <algorithm>

#include "bench/measure.h"
#include "bench/soil_steps.h"
#include "core/error.h"
#include "device/device.h"
#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/soils.h"
#include "soil/particles/schedule.h"

namespace navvy::bench {
namespace {

using lab::open_box;
using lab::Site;
using lab::SiteBox;

/// Returns `soil` with every option of the law: dilatancy, mu(I), compaction (LAW_EXTENDED).
scene::Soil every_option(scene::Soil soil) {
  soil.swell = 1.13;
  soil.dilatancy_angle = radians(8);
  soil.fast_friction_angle = radians(40);
  soil.compaction_pressure = 50e3;
  return soil;
}

/// A load at rest in a bucket: the cost of the shell without motion.
Row held_bucket(device::Device& device, const scene::Soil& soil, int steps) {
  Site site(device, {soil}, 0.1);
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
Row dig(device::Device& device, const scene::Soil& what, double length, double width, int steps) {
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
Row site_dig(device::Device& device, const scene::Soil& soil, double size, int steps) {
  lab::SiteOptions options;
  options.size = size;
  options.exchange = true;
  Site site(device, {soil}, 0.1, options);
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
  using Soil = scene::Soil;
  const auto collapse = [](double edge, int steps) {
    return [=](Device& d, const Soil& soil) {
      return time_steps(d, *collapsing_block(d, soil, edge), steps);
    };
  };
  return {
      {"soil_held_bucket", "a load at rest in a bucket", true,
       [](Device& d, const Soil& soil) { return held_bucket(d, soil, 100); }},
      {"soil_dig:29k", "a bucket drawn through a bed", true,
       [](Device& d, const Soil& soil) { return dig(d, soil, 3, 2, 100); }},
      {"soil_dig:96k", "the same in a longer bed", false,
       [](Device& d, const Soil& soil) { return dig(d, soil, 10, 2, 50); }},
      {"soil_dig:403k", "the same in a wide bed", false,
       [](Device& d, const Soil& soil) { return dig(d, soil, 12, 7, 20); }},
      {"soil_dig_extended_law:403k", "the same with dilatancy, mu(I) and compaction", false,
       [](Device& d, const Soil& soil) { return dig(d, every_option(soil), 12, 7, 20); }},
      {"soil_collapse_no_tool:2k", "a block of 0.6 m falling apart", true, collapse(0.6, 200)},
      {"soil_collapse_no_tool:8k", "1 m", true, collapse(1.0, 100)},
      {"soil_collapse_no_tool:27k", "1.5 m", false, collapse(1.5, 100)},
      {"soil_collapse_no_tool:50k", "1.85 m", false, collapse(1.85, 50)},
      {"soil_collapse_no_tool:64k", "2 m", true, collapse(2.0, 50)},
      {"soil_collapse_no_tool:216k", "3 m", false, collapse(3.0, 20)},
      {"soil_collapse_no_tool:512k", "4 m", false, collapse(4.0, 20)},
      {"soil_collapse_no_tool:1953k", "6.25 m", false, collapse(6.25, 5)},
      {"site_dig:0.01km2", "a dig on ground that becomes active", true,
       [](Device& d, const Soil& soil) { return site_dig(d, soil, 100, 100); }},
      {"site_dig:0.1km2", "the same on a larger site", false,
       [](Device& d, const Soil& soil) { return site_dig(d, soil, 316.2, 100); }},
      {"site_dig:1km2", "the same on a larger site", false,
       [](Device& d, const Soil& soil) { return site_dig(d, soil, 1000, 100); }},
  };
}

}  // namespace

const std::vector<SoilCase>& soil_cases() {
  static const std::vector<SoilCase> cases = make_cases();
  return cases;
}

double caller_below(const device::Device& device) { return soil::few_particles(device); }

scene::Soil bench_sand() { return lab::clean_sand(35); }

void run_soil_cases(device::Device& device, const SoilChoice& choice,
                    const std::function<void(const Row&)>& take) {
  std::vector<const SoilCase*> wanted;
  std::string names;
  for (const SoilCase& c : soil_cases()) {
    names += " " + c.name;
    // Part of the name is enough, so one word selects a family.
    if (c.name.find(choice.only) != std::string::npos && (!choice.quick || c.quick))
      wanted.push_back(&c);
  }
  if (wanted.empty())
    throw InputError(Fault{Fault::Severity::kError, "", 0, "bench", choice.only,
                           choice.quick ? "no short case has this word in its name"
                                        : "no case has this word in its name",
                           "one of:" + names});
  const scene::Soil soil = choice.soil.value_or(bench_sand());
  for (const SoilCase* c : wanted) {
    // Beside its row, so that other load on the machine affects both alike.
    const Peak peak = measure_peak(device);
    Row row = c->run(device, soil);
    row.bench = c->name;
    if (choice.soil) row.bench += "@" + soil.name;
    row.device = device.info().name;
    row.driver = device.info().driver;
    row.peak = peak;
    take(row);
  }
}

}  // namespace navvy::bench
