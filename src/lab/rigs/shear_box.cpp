// SPDX-License-Identifier: Apache-2.0
// Rig `box`: direct shear.
//
// The classical test for friction: two halves of a sample move against each other under a load. At
// large strain and without dilatancy the ratio of shear to normal stress is sin phi. Known
// deviation: the soil lifts the smooth lid, which passes no shear, so that part of the sample
// shears inside the ring and the ratio is low by a tenth to a fifth. The value has no tolerance.
// Rig `shear` reads the stress in the soil itself and has no such rim.
#include <cmath>

#include "lab/rig_shapes.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

/// Returns lid and ring in one: a box open at the bottom, lid at z = `height`.
scene::Shell inverted_box(double length, double width, double height) {
  scene::Shell s = open_box(length, width, height);
  for (Vec3& v : s.vertices) v.z() = height - v.z();
  // Inside remains the front.
  for (auto& t : s.triangles) std::swap(t[1], t[2]);
  return s;
}

/// Returns the largest shear over `normal` [N] in the first half of the travel, averaged over
/// windows of a fiftieth of it: a single step would be noise.
double peak_ratio(const Trace& trace, double travel, double normal) {
  double peak = 0;
  for (double from = 0; from < 0.5 * travel; from += 0.02 * travel) {
    const Vec3 force = mean_force(trace, from, from + 0.02 * travel);
    // Without a step in the window: NaN.
    if (std::isfinite(force.x())) peak = std::max(peak, -force.x() / normal);
  }
  return peak;
}

/// Fills both halves in one, sets the ring over the upper one and drives it along x.
Report run(const Setup& setup) {
  const double cell = setup.cell, length = setup["length"] * cell, width = setup["width"] * cell,
               height = setup["height"] * cell, half = 0.25 * cell;
  const SiteBox lower{Vec3(-length / 2, -width / 2, -height), Vec3(length / 2, width / 2, 0)};
  SiteOptions options;
  options.size = 2 * (length + 8 * cell);
  options.depth = height + 8 * cell;
  options.surface = pit(lower);
  // A smooth ring: it passes force along x by its back wall, not by the skin of the others.
  Setup smooth = setup;
  smooth.soil = without_tool_friction(setup.soil);
  Site site(smooth, options);
  const double sigma = setup["sigma-pa"], area = length * width;
  auto soil = site.fill({lower.low, Vec3(length / 2, width / 2, height)});
  // Under the lid's weight from the start, so that the lid does not fall first.
  site.rest(soil, height, sigma);
  site.solver().insert(soil);
  scene::Shell shell = inverted_box(length + 2 * half, width + 2 * half, height + half);
  shell.half_thickness = half;
  ToolDriver driver(site, shell, make_pose(0, 0, 0));
  Tool& ring = site.tool(driver.tool());
  // Its weight is the normal load; free to sink, it keeps that load for any motion of the soil
  // below.
  ring.mass = sigma * area / kGravity;
  ring.lock_rotation = true;
  // The stable step is that of the ring's own speed.
  const double speed = setup["speed"], travel = setup["travel"] * length,
               dt = site.step_limit(speed);
  const int steps = static_cast<int>(std::ceil(travel / speed / dt));
  site.expect(steps * dt);
  for (int i = 0; i < steps; ++i) {
    // The carriage prescribes x and y; only z follows soil and weight.
    ring.motion.v_WT.x() = speed, ring.motion.v_WT.y() = 0;
    driver.step(dt);
  }
  const Trace& trace = driver.trace();
  // At large strain the ratio no longer grows.
  const double from = 0.5 * travel;
  const Vec3 force = mean_force(trace, from, travel);
  // The plane at z = 0 also carries the soil in the ring.
  const double weight = setup.soil.bank_density * area * height * kGravity;
  const double normal = force.z() + weight, ratio = -force.x() / normal;
  Report report;
  // Without a tolerance: the value includes the effects of rim and lid.
  report.add("tau over sigma, large strain", ratio, "", std::sin(setup.soil.friction_angle), kNone,
             kNone, "sin phi, zero dilatancy; rig `shear` has the tolerance");
  const double peak = peak_ratio(trace, travel, normal);
  report.add("tau over sigma, peak", peak, "", std::tan(setup.soil.friction_angle), kNone, kNone,
             "the peak may approach tan phi");
  report.add("normal stress", force.z() / area, "Pa", sigma, kNone, kNone, "what the lid feels");
  // Leakage under the rim and the rise of the lid, the known deviations of this rig.
  report.note("lid sank by", -1000 * driver.pose().translation().z(), "mm");
  report.note("soil left in the ring", site.solver().payload(driver.tool(), driver.pose()), "kg");
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  driver.write(report, 10);
  site.finish(report);
  return report;
}

}  // namespace

Rig shear_box_rig() {
  Rig rig;
  rig.name = "box";
  rig.summary = "direct shear: tau over sigma at large strain is sin phi";
  rig.drawing =
      "The lower half of the sample lies in a pit of `length` x `width` x `height` whose walls "
      "are resting ground. The upper half lies in a smooth ring of the same size with a lid, "
      "which rests on it with the weight sigma-pa x area and is free to sink. The ring moves "
      "along x at `speed` by `travel` lengths. tau over sigma is the mean horizontal force over "
      "the weight on the plane between the halves, in the second half of the travel. Soil that "
      "leaks under the ring's rim shows as sinking of the lid.";
  rig.parameters = {{"length", 24, "cells", "of the sample", above(0)},
                    {"width", 8, "cells", "of the sample", above(0)},
                    {"height", 4, "cells", "of each half", above(0)},
                    {"sigma-pa", 5000, "Pa", "under the lid", above(0)},
                    {"speed", 0.2, "m/s", "of the ring", above(0)},
                    {"travel", 0.08, "lengths", "of the ring", above(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
