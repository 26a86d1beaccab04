// SPDX-License-Identifier: Apache-2.0
// Rig `throw`: soil without swell thrown apart in a bin; it must land in the volume it left.
//
// Soil that flies apart opens; its particles' volume ratio grows without stress. When it lands it
// must close again to the volume it left, or to its swell, neither as a foam that keeps the voids
// of its flight nor pressed into itself. Two readings that fail differently: the surface over the
// bin sees what is there, mass times tracked ratio tells what the law believes.
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Swell, pouring and heaps]";

/// Volumes over bank volume, by two independent measures.
struct Volume {
  double by_surface = 0;  ///< under the surface, over the whole bin
  double in_middle = 0;   ///< the same two cells clear of the walls: mean height over bank height
  double by_state = 0;    ///< sum of mass x tracked volume ratio
  double rms = 0;         ///< speed [m/s]
};

/// `bank_height` is the depth of the soil before: volumes are ratios to it.
Volume measure(const Site& site, double edge, double floor, double bank_height) {
  Volume out;
  const auto particles = site.solver().particles();
  const HeapSurface surface = surface_of(in_contact(site, particles), site.cell(), floor);
  double whole = 0, whole_count = 0, sum = 0, count = 0, mass = 0, swollen = 0, speed = 0;
  for (int iy = 0; iy < surface.ny; ++iy)
    for (int ix = 0; ix < surface.nx; ++ix) {
      const double off_middle = surface.middle(ix, iy).cwiseAbs().maxCoeff();
      // Next to a wall the ball of the surface finds no grains beyond it and falls.
      if (off_middle > edge / 2 - 0.5 * site.cell()) continue;
      whole += surface.at(ix, iy) - floor;
      whole_count += 1;
      // Two cells off the walls the grains lie as in an open bed.
      if (off_middle > edge / 2 - 2 * site.cell()) continue;
      sum += surface.at(ix, iy) - floor;
      count += 1;
    }
  for (const soil::Particle& p : particles) {
    // The law's own volume ratio, weighted with mass: what it believes, beside what can be seen.
    mass += p.mass;
    swollen += p.mass * static_cast<double>(p.j);
    speed += static_cast<double>(p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2]);
  }
  out.by_surface = whole / whole_count / bank_height;
  out.in_middle = sum / count / bank_height;
  out.by_state = swollen / mass;
  out.rms = std::sqrt(speed / static_cast<double>(particles.size()));
  return out;
}

/// Particles a cell in layers one cell thick from the floor up, `margin` cells clear of the walls.
Series profile(const Site& site, double edge, double margin, const std::string& name) {
  Series out{name, "", {}};
  // The bin stands on edge in its own frame; seen from the world it is a square about the axis.
  const double half = edge / 2 - margin * site.cell();
  for (const soil::Particle& p : site.solver().particles()) {
    const Vec3 at = site.position(p);
    if (at.head<2>().cwiseAbs().maxCoeff() > half) continue;
    const auto layer = static_cast<std::size_t>(std::max(0.0, at.z() / site.cell()));
    if (layer >= out.values.size()) out.values.resize(layer + 1, 0.0);
    out.values[layer] += std::pow(site.cell() / (2 * half), 2);
  }
  return out;
}

/// What lies there now on its way up: the upper half faster than the lower, each grain a little
/// aside.
std::vector<soil::Particle> thrown(const Site& site, double speed, double height) {
  // A fixed seed: two runs throw the same grains alike.
  Random random(1);
  auto out = site.solver().particles();
  for (soil::Particle& p : out) {
    const double share = std::clamp(site.position(p).z() / height, 0.0, 1.0);
    p.v[2] = static_cast<float>(speed * (0.5 + share));
    p.v[0] = static_cast<float>(random.uniform(-0.5, 0.5));
    p.v[1] = static_cast<float>(random.uniform(-0.5, 0.5));
  }
  return out;
}

/// The results by name.
void judge(Report& report, const Volume& before, const Volume& after, const Series& by_state,
           double swell) {
  const double most = by_state.values.empty()
                          ? kNone
                          : *std::max_element(by_state.values.begin(), by_state.values.end());
  // Swell 1 lands where it lay; a law that keeps what opened would not.
  report.note("opened in flight to, V/V0", most, "");
  report.add("V/V0 by the surface", after.by_surface / before.by_surface, "", swell, 0.95 * swell,
             1.05 * swell, kSource);
  report.add("V/V0 by mass and state", after.by_state / before.by_state, "", swell, 0.95 * swell,
             1.05 * swell, kSource);
  report.note("V/V0 by the surface, in the middle", after.in_middle / before.in_middle, "");
  report.note("surface over state before the throw", before.by_surface / before.by_state, "",
              "bias of the measure");
  report.note("rms speed at the end", 1000 * after.rms, "mm/s");
}

/// Rests, throws and lands: the throw starts in a second site that takes over the first one's
/// particles.
Report run(const Setup& setup) {
  const double cell = setup.cell, edge = setup["edge"], height = setup["height"];
  Setup smooth = setup;
  smooth.soil = without_tool_friction(setup.soil);
  SiteOptions options;
  options.size = 4 * edge;
  options.depth = 8 * cell;
  Site site(smooth, options);
  // Walls higher than the fastest grain flies.
  const double lift = setup["speed"] * setup["speed"] / kGravity;
  scene::Shell bin = tube(edge / std::sqrt(2.0), -6 * cell, height + 2 * lift + 10 * cell, 4);
  bin.half_thickness = 0.2 * cell;
  const Vec3 off(0.13 * cell, 0.07 * cell, 0);  // walls off the grid's planes
  site.add_tool(bin, make_pose(off.x(), off.y(), 0, 0, 0, radians(45)));
  const double half = edge / 2 - 0.25 * cell;
  auto soil = site.fill({off + Vec3(-half, -half, 0), off + Vec3(half, half, height)});
  site.rest(soil, height);
  site.solver().insert(soil);
  // Up and down again for the grains of the upper half, one and a half times as fast, and some.
  const double flight = 4 * setup["speed"] / kGravity;
  site.expect(0.3 + flight + setup["rest"]);
  site.run(0.3);
  // At rest first: the ratio leaves the bias of the surface out.
  const Volume before = measure(site, edge, 0, height);

  // The books see soil that comes in; what lay there is left out of them by starting a second site.
  Site flying(smooth, options);
  flying.add_tool(bin, make_pose(off.x(), off.y(), 0, 0, 0, radians(45)));
  flying.solver().insert(thrown(site, setup["speed"], height));
  Series time{"time", "s", {}}, by_surface{"volume by surface", "", {}},
      by_state{"volume by state", "", {}};
  const double seconds = flight + setup["rest"];
  // Enough samples to see how far it opens at the top of its flight.
  for (int i = 1; i <= 20; ++i) {
    flying.run(seconds / 20);
    const Volume now = measure(flying, edge, 0, height);
    time.values.push_back(flying.time());
    by_surface.values.push_back(now.by_surface);
    by_state.values.push_back(now.by_state);
  }
  const Volume after = measure(flying, edge, 0, height);
  Report report;
  judge(report, before, after, by_state, setup.soil.swell);
  report.note("particles through a wall",
              static_cast<double>(flying.solver().stats().shell_crossings), "");
  report.series = {time, by_surface, by_state,
                   profile(flying, edge, 0.25, "particles a cell by layer"),
                   profile(flying, edge, 2, "particles a cell by layer in the middle")};
  flying.finish(report);
  return report;
}

}  // namespace

Rig throw_rig() {
  Rig rig;
  rig.name = "throw";
  rig.summary = "soil thrown apart in a bin lands in the volume it left";
  rig.drawing =
      "A smooth square bin of `edge` on level ground holds soil `height` deep. After 0.3 s at rest "
      "every grain gets a "
      "velocity upwards, half of `speed` at the bottom and one and a half of it at the top, and up "
      "to 0.5 m/s aside: "
      "the soil opens, flies and lands. After the flight and `rest` the volume is read twice: "
      "under the surface a "
      "ball rolls on over the particles, and as mass times the tracked volume ratio. Soils with "
      "swell must land at it.";
  rig.parameters = {{"edge", 1.2, "m", "of the bin", above(0)},
                    {"height", 0.6, "m", "depth of the soil", above(0)},
                    {"speed", 3, "m/s", "mean velocity of the throw", above(0)},
                    {"rest", 2, "s", "after landing", at_least(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
