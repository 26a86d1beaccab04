// SPDX-License-Identifier: Apache-2.0
// Rig `throw`: soil without swell is thrown apart in a bin and must land in its former volume.
//
// Soil that flies apart opens: the volume ratio of its particles grows without stress. When it
// lands it must close again to its former volume, or to its swell. It must neither keep the voids
// of its flight nor be compressed. Two readings with different errors: the surface over the bin
// shows the real volume; mass times tracked ratio shows that of the law.
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
  /// Under the surface, over the whole bin.
  double by_surface = 0;
  /// The same, two cells clear of the walls: mean height over bank height.
  double in_middle = 0;
  /// Sum of mass x tracked volume ratio.
  double by_state = 0;
  /// Speed [m/s].
  double rms = 0;
};

/// Measures the soil. `bank_height` is its former depth: volumes are ratios to it.
Volume measure(const Site& site, double edge, double floor, double bank_height) {
  Volume out;
  const auto particles = site.solver().particles();
  const HeapSurface surface = surface_of(in_contact(site, particles), site.cell(), floor);
  double whole = 0, whole_count = 0, sum = 0, count = 0, mass = 0, swollen = 0, speed = 0;
  for (int iy = 0; iy < surface.ny; ++iy)
    for (int ix = 0; ix < surface.nx; ++ix) {
      const double off_middle = surface.middle(ix, iy).cwiseAbs().maxCoeff();
      // Next to a wall the ball of the surface finds no particles beyond it and falls.
      if (off_middle > edge / 2 - 0.5 * site.cell()) continue;
      whole += surface.at(ix, iy) - floor;
      whole_count += 1;
      // Two cells off the walls, particles lie as in an open bed.
      if (off_middle > edge / 2 - 2 * site.cell()) continue;
      sum += surface.at(ix, iy) - floor;
      count += 1;
    }
  for (const soil::Particle& p : particles) {
    // The law's own volume ratio, weighted with mass.
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

/// Returns particles per cell in layers one cell thick from the floor up, `margin` cells clear of
/// the walls.
Series profile(const Site& site, double edge, double margin, const std::string& name) {
  Series out{name, "", {}};
  // The bin stands on edge in its own frame; in W it is a square about the axis.
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

/// Returns the particles with an upward velocity: the upper half faster than the lower, each with a
/// small sideways component.
std::vector<soil::Particle> thrown(const Site& site, double speed, double height) {
  // A fixed seed: two runs throw the particles alike.
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

/// Adds the results to the report.
void judge(Report& report, const Volume& before, const Volume& after, const Series& by_state,
           double swell) {
  const double most = by_state.values.empty()
                          ? kNone
                          : *std::max_element(by_state.values.begin(), by_state.values.end());
  // With swell 1 it lands in its former volume; a law that keeps openings would not.
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
  // Walls higher than the fastest particle flies.
  const double lift = setup["speed"] * setup["speed"] / kGravity;
  scene::Shell bin = tube(edge / std::sqrt(2.0), -6 * cell, height + 2 * lift + 10 * cell, 4);
  bin.half_thickness = 0.2 * cell;
  // Walls off the grid's planes.
  const Vec3 off(0.13 * cell, 0.07 * cell, 0);
  site.add_tool(bin, make_pose(off.x(), off.y(), 0, 0, 0, radians(45)));
  const double half = edge / 2 - 0.25 * cell;
  auto soil = site.fill({off + Vec3(-half, -half, 0), off + Vec3(half, half, height)});
  site.rest(soil, height);
  site.solver().insert(soil);
  // Up and down again for the particles of the upper half, one and a half times as fast, plus a
  // margin.
  const double flight = 4 * setup["speed"] / kGravity;
  site.expect(0.3 + flight + setup["rest"]);
  site.run(0.3);
  // At rest first: the ratio removes the bias of the surface.
  const Volume before = measure(site, edge, 0, height);

  // The ledger records soil that comes in; a second site leaves the former soil out of it.
  Site flying(smooth, options);
  flying.add_tool(bin, make_pose(off.x(), off.y(), 0, 0, 0, radians(45)));
  flying.solver().insert(thrown(site, setup["speed"], height));
  Series time{"time", "s", {}}, by_surface{"volume by surface", "", {}},
      by_state{"volume by state", "", {}};
  const double seconds = flight + setup["rest"];
  // Enough samples to show the opening at the top of the flight.
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
  rig.summary = "soil thrown apart in a bin lands in its former volume";
  rig.drawing =
      "A smooth square bin of `edge` on level ground holds soil `height` deep. After 0.3 s at "
      "rest every particle gets an upward velocity, half of `speed` at the bottom and one and a "
      "half of it at the top, and up to 0.5 m/s sideways: the soil opens, flies and lands. After "
      "the flight and `rest` the volume is read twice: under the surface on which a ball rolls "
      "over the particles, and as mass x tracked volume ratio. Soils with swell must land at it.";
  rig.parameters = {{"edge", 1.2, "m", "of the bin", above(0)},
                    {"height", 0.6, "m", "depth of the soil", above(0)},
                    {"speed", 3, "m/s", "mean velocity of the throw", above(0)},
                    {"rest", 2, "s", "after landing", at_least(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
