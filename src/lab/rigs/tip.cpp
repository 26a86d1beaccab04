// SPDX-License-Identifier: Apache-2.0
// Rig `tip`: a thin plate pushed edge first into level ground, and held there.
//
// A plate is thinner than a cell, so its end is no face to the grid; the solver gives it the
// bearing resistance of the soil [docs/tools.md, edges]. The rig compares the force with the
// bearing capacity of a strip as wide as the plate is thick, between that of remoulded and of
// intact soil.
#include <algorithm>
#include <cmath>

#include "lab/rig_shapes.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/tools.md, edges]";

/// Share of the path, at its end, over which the force is averaged.
constexpr double kWindow = 0.1;
/// Time at the end of the hold over which the force is averaged [s].
constexpr double kLast = 0.5;

/// Force on the edge: whole, and its part that the solver attributes to edges [N].
struct TipForce {
  double whole = 0, edge = 0;
};

/// Returns the mean over the entries of the trace from index `from` on.
TipForce mean_from(const Trace& trace, std::size_t from) {
  TipForce out;
  const auto count = static_cast<double>(trace.force.size() - from);
  for (std::size_t i = from; i < trace.force.size(); ++i) {
    out.whole += trace.force[i].z() / count;
    out.edge += trace.edge[i].z() / count;
  }
  return out;
}

/// Returns the bearing resistance of the plate's end at depth z in soil of this cohesion [N].
double bearing(const Setup& setup, double cohesion, double z) {
  const double phi = setup.soil.friction_angle;
  const double pressure =
      cohesion * bearing_nc(phi) + setup.soil.bank_density * kGravity * z * bearing_nq(phi);
  return pressure * setup["thickness"] * setup["width"];
}

/// Pushes the plate down and holds it.
Report run(const Setup& setup) {
  const double cell = setup.cell, width = setup["width"], deep = setup["depth"],
               speed = setup["speed"];
  const double x = whole_cells(0.4, cell), y = whole_cells(width / 2 + 0.2, cell),
               z = whole_cells(deep + 0.35, cell);
  const SiteBox bed{Vec3(-x, -y, -z), Vec3(x, y, 0)};
  SiteOptions options;
  options.energy = setup.energy;
  options.size = 2 * (std::max(x, y) + 4 * cell);
  options.depth = z + 8 * cell;
  options.surface = pit(bed);
  // Smooth: the force on the faces would hide that on the edge.
  Site site(setup, {without_tool_friction(setup.soil)}, options);
  auto soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);
  const bool block = setup.is("block", "yes");
  scene::Shell shell =
      block ? closed_box(setup["thickness"], width, deep + 0.3) : blade(width, deep + 0.3);
  if (!block) {
    shell.half_thickness = setup["thickness"] / 2;
    shell.edge_share = 1;
    shell.edge_bevel = radians(setup["bevel-deg"]);
  }
  const double above = 0.5 * cell;
  ToolDriver driver(site, shell, make_pose(setup["offset"] * cell, 0.07 * cell, above));
  const double hold = setup["hold"], path = deep + above;
  site.expect(path / speed + hold);
  driver.advance((1 - kWindow) * path, Vec3(0, 0, -speed));
  std::size_t from = driver.trace().force.size();
  driver.advance(kWindow * path, Vec3(0, 0, -speed));
  const TipForce moving = mean_from(driver.trace(), from);
  const double at = deep - 0.5 * kWindow * path;
  Report report;
  const double low = bearing(setup, setup.soil.residual_cohesion, at),
               high = bearing(setup, setup.soil.cohesion, at);
  report
      .add("tip force", moving.whole / 1000, "kN", 0.5 * (low + high) / 1000, 0.75 * low / 1000,
           1.25 * high / 1000, std::string("[Prandtl 1920] ") + kSource)
      .holds_for("a blunt edge", setup["bevel-deg"] > 179.9);
  report.note("part on the edge", moving.edge / 1000, "kN");
  report.note("bearing capacity, remoulded", low / 1000, "kN", "residual cohesion");
  report.note("bearing capacity, intact", high / 1000, "kN", "whole cohesion");
  if (hold > 0) {
    driver.set_twist(Vec3::Zero());
    if (hold > kLast) driver.run(hold - kLast);
    from = driver.trace().force.size();
    driver.run(std::min(hold, kLast));
    report.add("force held over force in motion",
               mean_from(driver.trace(), from).whole / moving.whole, "", 1, 0.8, kNone,
               std::string("at rest is at rest ") + kSource);
  }
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  report.note("particles through the plate",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  driver.write(report, 10);
  site.finish(report);
  return report;
}

}  // namespace

Rig tip_rig() {
  Rig rig;
  rig.name = "tip";
  rig.summary = "thin plate pushed edge first into the ground and held: force on its edge";
  rig.drawing =
      "An upright smooth plate of `thickness` and `width` is pushed straight down into level "
      "ground "
      "at `speed` to `depth`, and then held still for `hold`. The force at the end of the path is "
      "compared with the bearing capacity of a strip as wide as the plate is thick, from that with "
      "the residual to that with the whole cohesion. `offset` places the plate between planes of "
      "the grid. With `block` it is a closed body, whose end is a face and no edge: it needs more "
      "than two cells of thickness.";
  rig.examples = {{"30 mm in loam", "--soil loam"},
                  {"60 mm in loam, finer cells", "--soil loam --thickness 0.06 --cell 0.05"}};
  rig.parameters = {
      {"thickness", 0.03, "m", "of the plate", above(0)},
      {"width", 0.6, "m", "of the plate", above(0)},
      {"depth", 0.4, "m", "of the edge at the end", above(0)},
      {"speed", 0.2, "m/s", "downwards", above(0)},
      {"hold", 4, "s", "at the end of the path", at_least(0)},
      {"bevel-deg", 180, "deg", "between the faces at the edge; 180: blunt", between(1, 180)},
      yes_no("block", false, "a closed body", "a plate with free edges"),
      {"offset", 0.03, "cells", "of the plate from a plane of the grid", between(-1, 1)}};
  rig.default_soil = cohesive(28, 5000);
  rig.experiment = run;
  rig.headline = {"tip force", "force held over force in motion"};
  return rig;
}

}  // namespace navvy::lab
