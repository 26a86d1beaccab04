// SPDX-License-Identifier: Apache-2.0
// Rig `cone`: heaps built at a given angle, one that should stand and one that should slide.
//
// This is a sharper test than `pour`: nothing falls; the heap starts at an angle a little below or
// above what its friction holds. A law with a threshold keeps the first and loses the second.
// Viscosity in place of a threshold would lose both slowly.
#include <algorithm>
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Swell, pouring and heaps]";

/// Result of one heap.
struct Outcome {
  /// Flank angle [deg].
  double before = 0, after = 0;
  /// 99th percentile of displacements [m].
  double moved = 0;
};

/// Builds a heap at `angle` [deg], waits for `time`, and adds the run to the report.
Outcome stand(const Setup& setup, double angle, Report& report) {
  const bool round = setup.is("shape", "cone");
  const double base = setup["base"], cell = setup.cell, gap = setup["gap"] * cell,
               slope = std::tan(radians(angle));
  SiteOptions options;
  // A heap that slides ends within twice its base.
  options.size = 6 * base;
  options.depth = 8 * cell;
  Setup smooth = setup;
  if (!round) smooth.soil = without_tool_friction(setup.soil);
  Site site(smooth, options);
  site.expect(setup["time"]);
  if (!round) {
    scene::Shell walls = channel(5 * base, gap, -6 * cell, base + 8 * cell, false);
    walls.half_thickness = 0.2 * cell;
    site.add_tool(walls, make_pose(-2.5 * base, -gap / 2 + 0.07 * cell, 0));
  }
  // Straight flanks from the axis to the base.
  const auto surface = [=](double x, double y) {
    return slope * (base - (round ? std::hypot(x, y) : std::abs(x)));
  };
  // A quarter of a cell off the plates, half the spacing of particles; the plates are off the
  // grid's planes.
  const double y = round ? base : gap / 2 - 0.25 * cell, middle = round ? 0 : 0.07 * cell;
  auto soil = site.fill({Vec3(-base, middle - y, 0), Vec3(base, middle + y, slope * base)},
                        [&](const Vec3& p) { return p.z() < surface(p.x(), p.y()); });
  // The stress of level ground under each point is not that of a heap: its flanks must find their
  // shear themselves.
  site.rest(soil, surface);
  site.solver().insert(soil);
  // The same reading before and after: its bias cancels in the difference.
  const auto flank = [&] {
    return degrees(flank_angle(surface_of(in_contact(site, site.solver().particles()), cell, 0),
                               Vec2::Zero(), round, cell));
  };
  Outcome out;
  out.before = flank();
  site.run(setup["time"]);
  out.after = flank();
  std::vector<double> moved;
  const auto end = site.solver().particles();
  for (std::size_t i = 0; i < end.size(); ++i)
    moved.push_back((site.position(end[i]) - site.position(soil[i])).norm());
  // The last percent are particles that roll down the flank one by one.
  out.moved = percentile(std::move(moved), 0.99);
  site.finish(report);
  return out;
}

/// Runs one heap that must stand and one that must slide; both are judged by the change of their
/// angle.
Report run(const Setup& setup) {
  Report report;
  const double phi = degrees(setup.soil.friction_angle);
  const Outcome low = stand(setup, phi + setup["stands"], report),
                high = stand(setup, phi + setup["slides"], report);
  // The built heap is read like the remaining one: the lattice makes steps in the flank.
  report.note("lower heap, angle built", low.before, "deg");
  report
      .add("lower heap, angle lost", low.before - low.after, "deg", 0, kNone, 1,
           std::string("stands ") + kSource)
      .holds_for("phi - 2 or less", setup["stands"] < -1.999);
  report.note("lower heap, farthest motion (99 %)", 1000 * low.moved, "mm");
  report.note("steeper heap, angle built", high.before, "deg");
  report
      .add("steeper heap, angle lost", high.before - high.after, "deg", kNone, 1.5, kNone,
           std::string("slides ") + kSource)
      .holds_for("phi + 3 or more, no cohesion",
                 setup["slides"] > 2.999 && !(setup.soil.cohesion > 0));
  report.note("steeper heap, angle at the end", high.after, "deg");
  report.note("steeper heap, farthest motion (99 %)", 1000 * high.moved, "mm");
  return report;
}

}  // namespace

Rig cone_rig() {
  Rig rig;
  rig.name = "cone";
  rig.summary = "heaps built at an angle: one must stand, a steeper one must slide";
  rig.drawing =
      "A heap of half width `base` is built on rough level ground with straight flanks and the "
      "vertical stress of the soil above each point, once at phi + `stands` and once at phi + "
      "`slides` degrees, and then observed for `time`. It stands if its flank loses at most 1 "
      "degree, and slides if it loses at least 1.5. `shape` plane: between smooth plates `gap` "
      "cells apart; cone: free (triaxial, with a lower strength than phi gives).";
  rig.parameters = {
      choice("shape", "plane", "", {{"plane", 0, "between plates"}, {"cone", 1, "free"}}),
      {"base", 2, "m", "half width", above(0)},
      {"gap", 5, "cells", "between the side plates", above(0)},
      {"stands", -2, "deg", "angle of the lower heap against phi", any()},
      {"slides", 3, "deg", "angle of the steeper heap against phi", above(0)},
      {"time", 3, "s", "simulated time of each", above(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
