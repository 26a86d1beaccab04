// SPDX-License-Identifier: Apache-2.0
// Rig `pour`: angle of repose of a heap poured from above, and whether it keeps it.
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/shapes.h"
#include "lab/site.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

/// A stream of loose grains, `speed` fast at its mouth, that follows the heap's top at a height of `drop`.
struct Stream {
  bool axisymmetric;
  double half, gap, speed, drop;

  /// One layer, half a cell thick. Grains are shaken off their lattice: no stream is a crystal.
  void emit(Site& site, double top, Random& random) const {
    const double z = top + drop, h = site.cell() / 2;
    const double y = axisymmetric ? half : gap / 2 - 0.25 * site.cell();
    auto layer = site.fill({Vec3(-half, -y, z), Vec3(half, y, z + h)},
                           [this](const Vec3& p) { return !axisymmetric || p.head<2>().norm() < half; });
    for (soil::Particle& p : layer) {
      for (float& x : p.x) x += static_cast<float>(random.uniform(-0.1, 0.1));
      p.v[2] = static_cast<float>(-speed);
    }
    site.solver().insert(layer);
  }
};

double angle_of(const Site& site, bool axisymmetric) {
  const Surface surface = surface_of(in_contact(site, site.solver().particles()), site.cell(), 0);
  return degrees(flank_angle(surface, Vec2::Zero(), axisymmetric, site.cell()));
}

double rms_speed(const Site& site) {
  double sum = 0, count = 0;
  for (const soil::Particle& p : site.solver().particles()) {
    for (const float v : p.v) sum += static_cast<double>(v) * static_cast<double>(v);
    count += 1;
  }
  return std::sqrt(sum / count);
}

/// Pours until the heap has `volume`; the mouth follows the top.
void pour_out(Site& site, const Stream& stream, double volume) {
  Random random(1);
  const double poured = site.soil().bank_density * volume;
  double top = 0;
  for (int layer = 0; kilograms(site.solver().ledger().inserted[0]) < poured; ++layer) {
    if (layer % 8 == 0 && layer > 0)
      top = surface_of(in_contact(site, site.solver().particles(), 40), site.cell(), 0).highest();
    // The stream itself is no heap: its mouth never rises faster than the heap can.
    stream.emit(site, std::min(top, layer * site.cell() / 8), random);
    site.run(site.cell() / 2 / stream.speed);
  }
}

Report run(const Setup& setup) {
  const bool round = setup.whole("shape") == 1;
  const double base = setup["base"], slope = std::sin(setup.soil.friction_angle), gap = setup["gap"] * setup.cell;
  const Stream stream{round, setup["stream"] * setup.cell, gap, setup["speed"], setup["drop"] * setup.cell};
  const double volume = round ? kPi / 3 * base * base * base * slope : base * base * slope * gap;
  SiteOptions options;
  options.size = 8 * base;
  options.depth = 8 * setup.cell;
  Setup smooth = setup;
  if (!round) smooth.soil.tool_friction_angle = smooth.soil.adhesion = 0;  // the side plates
  Site site(smooth, options);
  if (!round) {
    scene::Shell walls = channel(6 * base, gap, -6 * setup.cell, 2 * base, false);
    walls.half_thickness = 0.2 * setup.cell;
    site.add_tool(walls, make_pose(-3 * base, -gap / 2, 0));
  }
  const double area = round ? kPi * stream.half * stream.half : 2 * stream.half * gap;
  const double pouring = volume / area / stream.speed, resting = setup["rest"];
  site.expect(pouring + resting + 2);
  pour_out(site, stream, volume);
  site.run(2);

  const double at_first = angle_of(site, round);
  Series time{"rest time", "s", {0}}, angle{"flank angle", "deg", {at_first}};
  for (int i = 1; i <= 5; ++i) {
    site.run(resting / 5);
    time.values.push_back(resting * i / 5);
    angle.values.push_back(angle_of(site, round));
  }
  Report report;
  Series distance{"distance from the axis", "m", {}}, height{"mean height", "m", {}};
  const Surface end = surface_of(in_contact(site, site.solver().particles()), setup.cell, 0);
  for (const auto& [r, z] : flank_profile(end, Vec2::Zero(), round, setup.cell)) {
    distance.values.push_back(r);
    height.values.push_back(z);
  }
  const double phi = degrees(setup.soil.friction_angle), flow = degrees(flow_angle(setup.soil.friction_angle));
  report.add("repose after pouring", at_first, "deg", flow, flow - 1.5, phi + 1, "VALIDATION 2");
  report.add("repose after rest", angle.values.back(), "deg", flow, flow - 1.5, phi + 1, "VALIDATION 2");
  report.add("angle lost at rest", at_first - angle.values.back(), "deg", 0, -0.5, 0.5, "no creep; VALIDATION 2");
  report.note("rms speed at the end", 1000 * rms_speed(site), "mm/s", "SOIL_SOLVER 3: 0.2 mm/s at 4 s");
  report.series = {time, angle, distance, height};
  site.finish(report);
  return report;
}

}  // namespace

Rig pour() {
  Rig rig;
  rig.name = "pour";
  rig.summary = "angle of repose of a poured heap, and whether it creeps";
  rig.drawing =
      "A stream of grains, `stream` cells in half width, falls from `drop` cells above the top of the heap it makes on "
      "rough level ground, until the heap would have a base of half width `base` at the angle atan(sin phi). Two "
      "seconds later, and again after `rest`, a line is fitted to the mean flank between 20 and 80 % of the height. "
      "Shape 0: between smooth plates `gap` cells apart, a plane heap; shape 1: a cone. phi is the plane-strain angle: "
      "a cone, being closer to triaxial states, is weaker.";
  rig.parameters = {{"shape", 0, "", "0: plane, 1: cone"},
                    {"base", 1.5, "m", "half width of the heap aimed at"},
                    {"gap", 5, "cells", "between the side plates"},
                    {"stream", 3, "cells", "half width of the stream"},
                    {"drop", 4, "cells", "height of the mouth above the heap's top"},
                    {"speed", 0.8, "m/s", "of the grains at the mouth"},
                    {"rest", 10, "s", "time at rest"}};
  rig.default_soil = clean_sand(35);
  rig.run = run;
  return rig;
}

}  // namespace navvy::lab
