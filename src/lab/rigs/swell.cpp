// SPDX-License-Identifier: Apache-2.0
// Rig `swell`: a bucket of bank soil is tipped out; the heap's volume against the bank's.
//
// Bank soil dug and let lie takes more room, by a quarter for loam. That factor belongs to the soil
// and is an input; the rig asks whether a load that is tipped in one piece, sheared only by its own
// fall, reaches it. Known error: where the load falls as a block it does not shear and so does not
// swell; the surface of the heap hides that by the stand-off of its lowest layer.
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Swell, pouring and heaps]";

struct HeapVolume {
  double by_surface = 0, by_state = 0;  ///< volume over bank volume
  double loose_share = 0;               ///< of the particles that lie about singly and are left out
  double crowding = 0;                  ///< particles a cell in the heap's middle, 8 in the bank
  double angle = 0;                     ///< of the flank [deg]
};

/// Reads the heap twice, by what can be seen and by what the law believes: they fail in different
/// ways.
HeapVolume measure(const Site& site) {
  HeapVolume out;
  const auto particles = site.solver().particles();
  const std::vector<Vec3> heap = in_contact(site, particles);
  // Eight particles a cell in the bank: what one of them stands for.
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
  // Crowding: particles below the surface by more than a cell, over the volume there.
  double inner = 0, volume = 0;
  for (int iy = 0; iy < surface.ny; ++iy)
    for (int ix = 0; ix < surface.nx; ++ix)
      volume += std::max(0.0, surface.at(ix, iy) - cell) * surface.spacing * surface.spacing;
  for (const Vec3& p : heap)
    if (p.z() < surface.over(p) - cell) inner += 1;
  out.crowding = volume > 0 ? inner / volume * cell * cell * cell : kNone;
  return out;
}

/// Particles a cell in layers one cell thick from the ground up, where the heap reaches a cell
/// above the layer.
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

/// Tips the load, draws the box away, lets the heap rest and measures it.
Report run(const Setup& setup) {
  const double cell = setup.cell, volume = setup["volume"];
  // A box whose load is 1.2 : 1 : 0.8; its walls stand 0.3 cells off the load.
  const double edge = std::cbrt(volume / 0.96), length = 1.2 * edge, width = edge,
               depth = 0.8 * edge;
  const double gap = 0.3 * cell;
  SiteOptions options;
  // A heap of wet soil is low and wide, single grains roll farther.
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

  // 140 degrees: the floor then stands steeper than any soil lies.
  const double turn = setup["turn"], tipping = radians(140) / turn;
  site.expect(0.3 + tipping + 1.2 + setup["rest"]);
  site.run(0.3);
  // The load has come to rest on the box's floor.
  site.tool(tool).motion.w_WT = Vec3(0, turn, 0);
  site.run(tipping);
  site.tool(tool).motion.w_WT = Vec3::Zero();
  site.run(0.6);
  site.tool(tool).motion.v_WT = Vec3(-2 * edge, 0, 2 * edge);  // out of the way
  site.run(0.6);
  site.tool(tool).motion.v_WT = Vec3::Zero();
  // What clings to the box is no part of the heap.
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
  // Averaged over the layers above the lowest, where the heap reaches well over each.
  const Series layers = profile(site);
  double above = 0, count = 0;
  for (std::size_t k = 1; k < layers.values.size(); ++k)
    if (!std::isnan(layers.values[k])) above += layers.values[k], count += 1;
  // Resting ground holds nodes up to a quarter of a cell above it: the lowest layer stands off by
  // that much.
  report.add(
      "the same without the lowest layer", 8 * count / above, "", swell, 0.95 * swell, 1.05 * swell,
      std::string("8 particles a cell in the bank over those in the layers above it ") + kSource);
  report.add("particles a cell inside the heap", got.crowding, "", 8 / swell, kNone, kNone,
             "8 in the bank");
  report.note("particles that lie about singly", 100 * got.loose_share, "%",
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
      "bank soil tipped from a bucket and left to rest: volume of the heap over its bank volume";
  rig.drawing =
      "An open box holds a block of undisturbed soil of `volume`, its floor `height` above rough "
      "level ground. It is "
      "turned upside down at `turn`, drawn away, and the heap rests for `rest`. Its volume is read "
      "twice: under the "
      "surface a ball rolls on over the particles, and as mass times the tracked volume ratio. "
      "Both are given over "
      "the bank volume of the particles counted. The number of particles in a cell inside the heap "
      "says how crowded "
      "they are.";
  rig.examples = {{"Soil without swell must keep its volume", "--swell 1 --cohesion-pa 0"}};
  rig.parameters = {{"volume", 1, "m3", "bank soil in the box", above(0)},
                    {"height", 1.2, "m", "of the box's floor", at_least(0)},
                    {"turn", 2, "rad/s", "tipping", above(0)},
                    {"rest", 2, "s", "after the box is gone", at_least(0)}};
  rig.default_soil = scene::Soil();
  rig.default_soil.name = "loam";
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
