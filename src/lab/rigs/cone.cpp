// SPDX-License-Identifier: Apache-2.0
// Rig `cone`: heaps built at a given angle, one that should stand and one that should slide.
#include <algorithm>
#include <cmath>

#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/shapes.h"
#include "lab/site.h"
#include "lab/soils.h"

namespace navvy::lab {
namespace {

struct Outcome {
  double before = 0, after = 0;  ///< flank angle [deg]
  double moved = 0;              ///< 99th percentile of displacements [m]
};

Outcome stand(const Setup& setup, double angle, Report& report) {
  const bool round = setup.whole("shape") == 1;
  const double base = setup["base"], cell = setup.cell, gap = setup["gap"] * cell, slope = std::tan(radians(angle));
  SiteOptions options;
  options.size = 6 * base;
  options.depth = 8 * cell;
  Setup smooth = setup;
  if (!round) smooth.soil.tool_friction_angle = smooth.soil.adhesion = 0;
  Site site(smooth, options);
  site.expect(setup["time"]);
  if (!round) {
    scene::Shell walls = channel(5 * base, gap, -6 * cell, base + 8 * cell, false);
    walls.half_thickness = 0.2 * cell;
    site.add_tool(walls, make_pose(-2.5 * base, -gap / 2 + 0.07 * cell, 0));
  }
  const auto surface = [=](double x, double y) { return slope * (base - (round ? std::hypot(x, y) : std::abs(x))); };
  const double y = round ? base : gap / 2 - 0.25 * cell, middle = round ? 0 : 0.07 * cell;
  auto soil = site.fill({Vec3(-base, middle - y, 0), Vec3(base, middle + y, slope * base)},
                        [&](const Vec3& p) { return p.z() < surface(p.x(), p.y()); });
  site.rest(soil, surface);
  site.solver().insert(soil);
  const auto flank = [&] {
    return degrees(
        flank_angle(surface_of(in_contact(site, site.solver().particles()), cell, 0), Vec2::Zero(), round, cell));
  };
  Outcome out;
  out.before = flank();
  site.run(setup["time"]);
  out.after = flank();
  std::vector<double> moved;
  const auto end = site.solver().particles();
  for (std::size_t i = 0; i < end.size(); ++i) moved.push_back((site.position(end[i]) - site.position(soil[i])).norm());
  out.moved = percentile(std::move(moved), 0.99);
  site.finish(report);
  return out;
}

Report run(const Setup& setup) {
  Report report;
  const double phi = degrees(setup.soil.friction_angle);
  const Outcome low = stand(setup, phi + setup["stands"], report), high = stand(setup, phi + setup["slides"], report);
  report.note("lower heap, angle built", low.before, "deg");
  report.add("lower heap, angle lost", low.before - low.after, "deg", 0, kNone, 1, "stands; VALIDATION 1");
  report.note("lower heap, farthest motion (99 %)", 1000 * low.moved, "mm");
  report.note("steeper heap, angle built", high.before, "deg");
  report.add("steeper heap, angle lost", high.before - high.after, "deg", kNone, 1.5, kNone, "slides; VALIDATION 1");
  report.note("steeper heap, angle at the end", high.after, "deg");
  report.note("steeper heap, farthest motion (99 %)", 1000 * high.moved, "mm");
  return report;
}

}  // namespace

Rig cone() {
  Rig rig;
  rig.name = "cone";
  rig.summary = "heaps built at an angle: one must stand, a steeper one must slide";
  rig.drawing =
      "A heap of half width `base` is built on rough level ground with straight flanks and the vertical stress of the "
      "soil above each point, once at phi + `stands` and once at phi + `slides` degrees. It is watched for `time`. It "
      "stands when its flank loses at most 1 degree, it slides when it loses at least 1.5. Shape 0: plane, between "
      "smooth plates `gap` cells apart; shape 1: a cone (triaxial: weaker than phi says).";
  rig.parameters = {{"shape", 0, "", "0: plane, 1: cone"},
                    {"base", 2, "m", "half width"},
                    {"gap", 5, "cells", "between the side plates"},
                    {"stands", -2, "deg", "angle of the lower heap against phi"},
                    {"slides", 3, "deg", "angle of the steeper heap against phi"},
                    {"time", 3, "s", "simulated time of each"}};
  rig.default_soil = clean_sand(35);
  rig.run = run;
  return rig;
}

}  // namespace navvy::lab
