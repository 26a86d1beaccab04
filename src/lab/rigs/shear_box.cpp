// SPDX-License-Identifier: Apache-2.0
// Rig `box`: direct shear.
#include <cmath>

#include "lab/rigs/tool_list.h"
#include "lab/shapes.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

/// Lid and ring in one: a box open at the bottom, lid at z = `height`.
scene::Shell inverted_box(double length, double width, double height) {
  scene::Shell s = open_box(length, width, height);
  for (Vec3& v : s.vertices) v.z() = height - v.z();
  for (auto& t : s.triangles) std::swap(t[1], t[2]);  // inside stays front
  return s;
}

Report run(const Setup& setup) {
  const double cell = setup.cell, length = setup["length"] * cell, width = setup["width"] * cell,
               height = setup["height"] * cell, half = 0.25 * cell;
  const Box lower{Vec3(-length / 2, -width / 2, -height), Vec3(length / 2, width / 2, 0)};
  SiteOptions options;
  options.size = 2 * (length + 8 * cell);
  options.depth = height + 8 * cell;
  options.surface = pit(lower);
  Setup smooth = setup;
  smooth.soil.tool_friction_angle = smooth.soil.adhesion = 0;
  Site site(smooth, options);
  const double sigma = setup["sigma-pa"], area = length * width;
  auto soil = site.fill({lower.low, Vec3(length / 2, width / 2, height)});
  site.rest(soil, height, sigma);
  site.solver().insert(soil);
  scene::Shell shell = inverted_box(length + 2 * half, width + 2 * half, height + half);
  shell.half_thickness = half;
  ToolDriver driver(site, shell, make_pose(0, 0, 0));
  Tool& ring = site.tool(driver.tool());
  ring.mass = sigma * area / kGravity;
  ring.keep_attitude = true;
  const double speed = setup["speed"], travel = setup["travel"] * length, dt = site.step_limit(speed);
  const int steps = static_cast<int>(std::ceil(travel / speed / dt));
  site.expect(steps * dt);
  for (int i = 0; i < steps; ++i) {
    ring.motion.v_WT.x() = speed, ring.motion.v_WT.y() = 0;
    driver.step(dt);
  }
  const Trace& trace = driver.trace();
  const double from = 0.5 * travel;
  const Vec3 force = mean_force(trace, from, travel);
  // The plane at z = 0 also carries the soil in the ring.
  const double weight = setup.soil.bank_density * area * height * kGravity;
  const double normal = force.z() + weight, ratio = -force.x() / normal;
  Report report;
  const double expected = std::sin(setup.soil.friction_angle);
  report.add("tau over sigma, large strain", ratio, "", expected, 0.97 * expected, 1.03 * expected,
             "sin phi, zero dilatancy; VALIDATION 1");
  double peak = 0;
  for (double at = 0; at < 0.5 * travel; at += 0.02 * travel) {
    const Vec3 f = mean_force(trace, at, at + 0.02 * travel);
    if (std::isfinite(f.x())) peak = std::max(peak, -f.x() / normal);
  }
  report.add("tau over sigma, peak", peak, "", std::tan(setup.soil.friction_angle), kNone, kNone,
             "the peak may approach tan phi");
  report.add("normal stress", force.z() / area, "Pa", sigma, kNone, kNone, "what the lid feels");
  report.note("lid sank by", -1000 * driver.pose().translation().z(), "mm");
  report.note("soil left in the ring", site.solver().payload(driver.tool(), driver.pose()), "kg");
  report.note("particles through the shell", static_cast<double>(site.solver().stats().shell_crossings), "");
  driver.write(report, 10);
  site.finish(report);
  return report;
}

}  // namespace

Rig shear_box() {
  Rig rig;
  rig.name = "box";
  rig.summary = "direct shear: tau over sigma at large strain is sin phi";
  rig.drawing =
      "The lower half of the sample lies in a pit of `length` x `width` x `height` whose walls are resting ground, the "
      "upper half in a smooth ring with a lid of the same size that rests on it with the weight sigma-pa x area, free "
      "to sink. The ring is moved along x at `speed` by `travel` lengths. tau over sigma is the mean horizontal force "
      "over the weight on the plane between the halves, in the second half of the travel. Soil that leaks under the "
      "ring's rim shows in the sinking of the lid.";
  rig.parameters = {{"length", 24, "cells", "of the sample"}, {"width", 8, "cells", "of the sample"},
                    {"height", 4, "cells", "of each half"},   {"sigma-pa", 5000, "Pa", "under the lid"},
                    {"speed", 0.2, "m/s", "of the ring"},     {"travel", 0.08, "lengths", "of the ring"}};
  rig.default_soil = clean_sand(35);
  rig.run = run;
  return rig;
}

}  // namespace navvy::lab
