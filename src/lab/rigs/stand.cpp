// SPDX-License-Identifier: Apache-2.0
// Rig `stand`: a body placed on the ground and left alone must stand.
//
// Stones, steel plates and tools of machines on the ground must not sink for ever: the ground fails
// or carries them. A body that rests on particles follows their motion, so only this rig shows
// creep of a contact; at a blade it is negligible beside the blade's speed.
#include <algorithm>
#include <cmath>

#include "lab/rig_shapes.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Buckets and carried loads]";

/// Returns a body about its centre.
scene::Shell body(double length, double width, double height) {
  scene::Shell out = closed_box(length, width, height);
  for (Vec3& v : out.vertices) v.z() -= height / 2;
  return out;
}

/// Returns a site around the body with level ground at height `level` [m].
SiteOptions site_options(const Setup& setup, double level) {
  const double cell = setup.cell, longest = std::max(setup["length"], setup["width"]);
  SiteOptions options;
  // A tool at rest activates a zone of one dig depth around it; nothing happens farther out.
  options.size = 2 * (whole_cells(longest / 2, cell) + 12 * cell);
  options.depth = whole_cells(2 * longest, cell);
  options.surface = [level](double, double) { return level; };
  options.exchange = true;
  return options;
}

Report run(const Setup& setup) {
  const double cell = setup.cell, length = setup["length"], width = setup["width"],
               height = setup["height"];
  // Between the planes of the grid, where most ground is.
  const double level = -setup["below-plane"] * cell;
  Site site(setup, site_options(setup, level));
  const scene::Shell shell = body(length, width, height);
  const double under = height / 2 + shell.half_thickness;
  ToolDriver driver(
      site, shell,
      make_pose(0.02, 0.01, level + under + setup["gap"] * cell, 0, radians(setup["tilt-deg"]), 0));
  Tool& tool = site.tool(driver.tool());
  tool.mass = setup["mass"];
  tool.inertia = tool.mass / 12 *
                 Vec3(width * width + height * height, length * length + height * height,
                      length * length + width * width);
  const double settled = setup["settle"], seconds = settled + setup["time"],
               dt = site.step_limit(0.5);
  site.expect(seconds);
  Series time{"time", "s", {}}, gap{"height of the lower face", "mm", {}};
  const auto stands = [&] { return tool.motion.X_WT.translation().z() - under - level; };
  double before = stands();
  Vec3 place = tool.motion.X_WT.translation();
  bool counting = false;
  for (double t = 0, shown = 0; t < seconds; t += dt) {
    driver.step(dt);
    if (!counting && t + dt >= settled) {
      counting = true;
      before = stands();
      place = tool.motion.X_WT.translation();
    }
    if (t < shown) continue;
    time.values.push_back(t);
    gap.values.push_back(1000 * stands());
    shown += 0.1;
  }
  Report report;
  report.add("sinking while it stands", 1000 * (before - stands()), "mm", 0, -1, 1,
             std::string("at rest is at rest ") + kSource);
  report.add("drift while it stands",
             1000 * (tool.motion.X_WT.translation() - place).head<2>().norm(), "mm", 0, 0, 1,
             std::string("at rest is at rest ") + kSource);
  const double share =
      driver.trace().force.empty() ? 0 : driver.trace().force.back().z() / (tool.mass * kGravity);
  report.add("force of the ground over the weight", share, "", 1, 0.99, 1.01,
             std::string("statics ") + kSource);
  report.note("sunk when it came to rest", -1000 * before, "mm",
              "its lower face, below the ground's surface");
  report.note("stand-off", stands() / cell, "cells", "its lower face over the ground's surface");
  const Vec3 up = tool.motion.X_WT.linear().col(2);
  report.note("tilt at the end", degrees(std::acos(std::min(1.0, up.z()))), "deg");
  report.note("pressure", tool.mass * kGravity / (length * width), "Pa");
  report.add("particles at the end", static_cast<double>(site.solver().stats().particles), "", 0, 0,
             0, std::string("its soil is in columns again ") + kSource);
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  report.series = {time, gap};
  site.finish(report);
  return report;
}

}  // namespace

Rig stand_rig() {
  Rig rig;
  rig.name = "stand";
  rig.summary = "a body on the ground stands: how far it sinks, and that it then stops";
  rig.drawing =
      "A closed box of `length`, `width`, `height` and `mass`, tilted by `tilt-deg`, is released "
      "`gap` cells above level ground, which becomes particles and returns to columns by itself. "
      "After `settle` it must stand: over `time` it neither sinks nor drifts by a millimetre. "
      "`below-plane` lowers the surface from a plane of the grid by a share of a cell.";
  rig.parameters = {
      {"length", 0.6, "m", "of the box", above(0)},
      {"width", 0.6, "m", "of the box", above(0)},
      {"height", 0.5, "m", "of the box", above(0)},
      {"mass", 468, "kg", "of the box", above(0)},
      {"gap", 0.5, "cells", "over the ground at the start", at_least(0)},
      {"tilt-deg", 0, "deg", "about its width, at the start", at_least(0)},
      {"below-plane", 0, "cells", "the surface under a plane of the grid", at_least(0)},
      {"settle", 10, "s", "before the observation", at_least(0)},
      {"time", 60, "s", "of observation", above(0)}};
  rig.default_soil = cohesive(28, 5000);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
