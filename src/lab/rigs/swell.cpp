// SPDX-License-Identifier: Apache-2.0
// Rig `swell`: a bucket of bank soil is dumped; the heap's volume is compared with the bank's.
//
// Excavated bank soil takes more volume, by a quarter for loam. That factor is an input of the
// soil. The rig tests whether a load that is dumped in one piece, sheared only by its own fall,
// reaches it. Such a load hardly opens in flight: it swells by dilatancy as it lands and spreads.
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Swell, pouring and heaps]";

struct HeapVolume {
  /// Volume over bank volume.
  double by_surface = 0, by_state = 0;
  /// Share of the single particles that are left out.
  double loose_share = 0;
  /// Particles per cell in the heap's middle, 8 in the bank.
  double crowding = 0;
  /// Of the flank [deg].
  double angle = 0;
};

/// Reads the heap twice, by its surface and by the law's state: the two have different errors.
HeapVolume measure(const Site& site) {
  HeapVolume out;
  const auto particles = site.solver().particles();
  const std::vector<Vec3> heap = in_contact(site, particles);
  // Eight particles per cell in the bank: the volume of one of them.
  const double cell = site.cell(), each = cell * cell * cell / 8;
  const HeapSurface surface = surface_of(heap, cell, 0);
  out.by_surface = surface.volume() / (each * static_cast<double>(heap.size()));
  out.loose_share = 1 - static_cast<double>(heap.size()) / static_cast<double>(particles.size());
  double mass = 0, swollen = 0;
  for (const soil::Particle& p : particles) {
    // j is the volume over that of the bank.
    mass += p.mass;
    swollen += p.mass * static_cast<double>(p.j);
  }
  out.by_state = swollen / mass;
  // Crowding: particles more than a cell below the surface, over the volume there.
  double inner = 0, volume = 0;
  for (int iy = 0; iy < surface.ny; ++iy)
    for (int ix = 0; ix < surface.nx; ++ix)
      volume += std::max(0.0, surface.at(ix, iy) - cell) * surface.spacing * surface.spacing;
  for (const Vec3& p : heap)
    if (p.z() < surface.over(p) - cell) inner += 1;
  out.crowding = volume > 0 ? inner / volume * cell * cell * cell : kNone;
  return out;
}

/// Returns particles per cell in layers one cell thick from the ground up, where the heap reaches a
/// cell above the layer.
Series profile(const Site& site) {
  const std::vector<Vec3> heap = in_contact(site, site.solver().particles());
  const double cell = site.cell();
  const HeapSurface surface = surface_of(heap, cell, 0);
  const auto layers = static_cast<std::size_t>(std::max(0.0, surface.highest() / cell - 1));
  std::vector<double> count(layers, 0.0), volume(layers, 0.0);
  for (const double top : surface.top)
    for (std::size_t k = 0; k < layers; ++k)
      if (top > cell * static_cast<double>(k + 2)) volume[k] += std::pow(surface.spacing / cell, 2);
  for (const Vec3& p : heap) {
    const auto k = static_cast<std::size_t>(std::max(0.0, p.z() / cell));
    if (k < layers && surface.over(p) > cell * static_cast<double>(k + 2)) count[k] += 1;
  }
  Series out{"particles a cell by layer", "", {}};
  for (std::size_t k = 0; k < layers; ++k)
    out.values.push_back(volume[k] > 4 ? count[k] / volume[k] : kNone);
  return out;
}

/// Dumps the load, removes the box, lets the heap rest and measures it.
/// Tips the box over and removes it. `edge` is the cube root of its volume [m].
void dump(Site& site, int tool, const Setup& setup, double edge) {
  // 140 degrees: the floor is then steeper than any slope of soil.
  const double turn = setup["turn"], tipping = radians(140) / turn;
  site.expect(0.3 + tipping + 1.2 + setup["rest"]);
  site.run(0.3);
  // The load has come to rest on the box's floor.
  site.tool(tool).motion.w_WT = Vec3(0, turn, 0);
  site.run(tipping);
  site.tool(tool).motion.w_WT = Vec3::Zero();
  site.run(0.6);
  // Out of the heap's range.
  site.tool(tool).motion.v_WT = Vec3(-2 * edge, 0, 2 * edge);
  site.run(0.6);
  site.tool(tool).motion.v_WT = Vec3::Zero();
}

Report run(const Setup& setup) {
  const double cell = setup.cell, volume = setup["volume"];
  // A box whose load is 1.2 : 1 : 0.8; its walls are 0.3 cells off the load.
  const double edge = std::cbrt(volume / 0.96), length = 1.2 * edge, width = edge,
               depth = 0.8 * edge;
  const double gap = 0.3 * cell;
  SiteOptions options;
  // A heap of wet soil is low and wide, and single particles roll farther.
  options.size = 24 * edge;
  options.depth = 8 * cell;
  Site site(setup, options);
  scene::Shell bucket = open_box(length + 2 * gap, width + 2 * gap, 1.3 * depth);
  const double height = setup["height"];
  const int tool = site.add_tool(bucket, make_pose(0.13 * cell, 0.07 * cell, height));
  const double z = height + gap;
  auto load = site.fill({Vec3(-length / 2, -width / 2, z), Vec3(length / 2, width / 2, z + depth)});
  const double bank = static_cast<double>(load.size()) * cell * cell * cell / 8;
  site.rest(load, z + depth);
  site.solver().insert(load);

  dump(site, tool, setup, edge);
  // Soil that clings to the box is no part of the heap.
  const double left = site.solver().payload(tool, site.tool(tool).motion.X_WT);
  site.run(setup["rest"]);

  const HeapVolume got = measure(site);
  const double swell = setup.soil.swell;
  Report report;
  report.note("bank volume tipped", bank, "m3");
  report.add("heap over bank by the surface", got.by_surface, "", swell, 0.95 * swell, 1.05 * swell,
             kSource);
  report.add("heap over bank by mass and state", got.by_state, "", swell, 0.95 * swell,
             1.05 * swell, kSource);
  // Averaged over the layers above the lowest, where the heap reaches well above each.
  const Series layers = profile(site);
  double above = 0, count = 0;
  for (std::size_t k = 1; k < layers.values.size(); ++k)
    if (!std::isnan(layers.values[k])) above += layers.values[k], count += 1;
  // The lowest layer stands off the resting ground by up to a fifth of a cell.
  report.add(
      "the same without the lowest layer", 8 * count / above, "", swell, 0.95 * swell, 1.05 * swell,
      std::string("8 particles a cell in the bank over those in the layers above it ") + kSource);
  report.add("particles a cell inside the heap", got.crowding, "", 8 / swell, kNone, kNone,
             "8 in the bank");
  report.note("single particles beside the heap", 100 * got.loose_share, "%",
              "not in the surface's volume");
  report.note("left in the bucket", left, "kg");
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  report.series = {layers};
  site.finish(report);
  return report;
}

}  // namespace

Rig swell_rig() {
  Rig rig;
  rig.name = "swell";
  rig.summary =
      "bank soil dumped from a bucket and left to rest: volume of the heap over its bank volume";
  rig.drawing =
      "An open box holds a block of undisturbed soil of `volume`, its floor `height` above rough "
      "level ground. The box is turned upside down at `turn` and removed, and the heap rests for "
      "`rest`. Its volume is read twice: under the surface on which a ball rolls over the "
      "particles, and as mass x tracked volume ratio. Both are given over the bank volume of the "
      "particles counted. The number of particles per cell inside the heap shows how crowded they "
      "are.";
  rig.examples = {{"Soil without swell must keep its volume", "--swell 1 --cohesion-pa 0"}};
  rig.parameters = {{"volume", 1, "m3", "bank soil in the box", above(0)},
                    {"height", 1.2, "m", "of the box's floor", at_least(0)},
                    {"turn", 2, "rad/s", "of the box when it is dumped", above(0)},
                    {"rest", 2, "s", "after the box is removed", at_least(0)}};
  rig.default_soil = scene::Soil();
  rig.default_soil.name = "loam";
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
