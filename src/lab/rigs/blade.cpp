// SPDX-License-Identifier: Apache-2.0
// Rig `blade`: a flat plate pushed through the ground.
//
// A blade in plane strain is the simplest case of digging: a wedge slides up between blade and
// rupture surface. For a smooth upright blade the surface is a plane and the force is exactly
// Rankine's. A rough upright blade bends it: the plane wedge is then only an upper bound, and slip
// lines and a log spiral give the reference (theory/earth_pressure.h). A rough or flat blade also
// lifts soil that piles up and rides on it, so the force grows with the travel. It is compared with
// a wedge under the present pile, which separates errors of the force from errors of the pile's
// shape. A narrow blade in open ground has crescents at its sides, too.
#include <algorithm>
#include <cmath>

#include "lab/rig_shapes.h"
#include "lab/rigs/blade_bed.h"
#include "lab/rigs/chute.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Blades and earth pressure]";

double rake_of(const Setup& setup) { return radians(setup["rake-deg"]); }

BladeCase case_of(const Setup& setup) {
  return blade_case(setup, rake_of(setup), setup["depth"], setup["width"]);
}

/// Returns the height of the blade's upper edge over its cutting edge [m].
double blade_height(const Setup& setup) {
  const double length = setup["length"];
  return length > 0 ? length * std::sin(radians(setup["rake-deg"]))
                    : setup["depth"] * (1 + setup["above"]);
}

/// Reference of the mean force, and its validity.
struct Tolerance {
  double expected = 0, low = kNone, high = kNone;
  std::string source, range;
  bool here = false;
};

/// Returns the tolerance of the mean force. A measured force replaces theory. Theory applies to
/// upright blades in plane strain: smooth ones within --tolerance-percent, rough ones from 0.95 of
/// the lower bound (0.80 with cohesion, as soil without dilatancy is weaker) to 1.05 of the spiral.
Tolerance tolerance_of(const Setup& setup, const BladeForce& wedge, const std::string& source) {
  const double given = setup["expected-n"], share = setup["tolerance-percent"] / 100;
  const bool upright = setup.is("plane", "yes") && std::abs(setup["rake-deg"] - 90) < 1e-6;
  const Reference theory = upright ? upright_reference(case_of(setup)) : Reference{};
  Tolerance out;
  out.range =
      "an upright blade in plane strain in soil that does not soften, E at least 200 c (rough: and "
      "4 MPa), or a "
      "force given by --expected-n";
  const double young = setup.soil.young_modulus;
  const bool stiff = young > 199.9 * setup.soil.cohesion && (!theory.rough || young > 3.99e6);
  out.here = given > 0 || (upright && stiff && !softens(setup.soil));
  out.expected = given > 0 ? given : upright ? theory.expected : wedge.horizontal;
  out.source = given > 0 ? std::string("--expected-n, of the experiments ") + kSource
               : upright ? theory.source + " " + kSource
                         : source;
  if (!(share > 0)) return out;
  const bool rough = theory.rough && !(given > 0);
  out.low =
      rough ? (setup.soil.cohesion > 0 ? 0.80 : 0.95) * theory.low : (1 - share) * out.expected;
  out.high = rough ? 1.05 * theory.high : (1 + share) * out.expected;
  return out;
}

/// Returns the largest force [N] without fluctuations of the grid: passing two cells of soil takes
/// 2 cell / v.
double smooth_peak(const Setup& setup, const Trace& trace, double scale) {
  std::vector<double> x;
  for (const Vec3& f : trace.force) x.push_back(-scale * f.x());
  double peak = 0;
  for (const double f : low_pass(trace.time, x, std::max(1.0, setup["speed"] / (2 * setup.cell))))
    peak = std::max(peak, f);
  return peak;
}

/// Reads the results of both kinds of bed from the trace. `wedge` is the formula for the kind of
/// bed.
void read_force(const Setup& setup, const ToolDriver& driver, double scale, const BladeForce& wedge,
                const std::string& source, Report& report) {
  const double from = setup["from"], to = setup["travel"];
  // One window for mean and scatter, as in the cited experiment.
  const Vec3 force = scale * mean_force(driver.trace(), from, to),
             scatter = scale * force_scatter(driver.trace(), from, to);
  const Tolerance tolerance = tolerance_of(setup, wedge, source);
  report
      .add("horizontal force", -force.x(), "N", tolerance.expected, tolerance.low, tolerance.high,
           tolerance.source)
      .holds_for(tolerance.range, tolerance.here);
  // The formula is listed beside any other expectation, without a tolerance; a planar wedge is an
  // upper bound.
  if (std::abs(tolerance.expected / wedge.horizontal - 1) > 1e-6)
    report.add("horizontal force, against the wedge", -force.x(), "N", wedge.horizontal, kNone,
               kNone, source + (setup.is("plane", "yes") ? ", planar wedge: an upper bound" : ""));
  if (softens(setup.soil)) {
    BladeCase intact = case_of(setup);
    intact.cohesion = setup.soil.cohesion;
    report.add("horizontal force, were the soil intact", -force.x(), "N",
               reece_wedge(intact).horizontal, kNone, kNone,
               "[Reece 1964], cohesion before remoulding: no limit of this soil");
  }
  report.add("vertical force on the blade, down", -force.z(), "N", wedge.vertical, kNone, kNone,
             source);
  // One number to compare runs of other soils and depths.
  report.add("horizontal over expected", -force.x() / tolerance.expected, "", 1, kNone, kNone, "");
  report.note("scatter of the force", 100 * scatter.x() / std::abs(force.x()), "%",
              "rms about the mean over its window");
  const double peak = smooth_peak(setup, driver.trace(), scale);
  report.note("peak, low-passed at v / (2 cells)", peak, "N");
  report.add("peak over expected", peak / tolerance.expected, "", 1, kNone, kNone, "");
}

/// Returns the height over the edge [m] of the soil at x ahead of it, averaged over the middle half
/// of the chute. Beyond the bed's end the ground rests, `depth` over the edge.
std::function<double(double)> profile(const Site& site, const Vec3& p_edge, const ChuteBed& bed,
                                      double gap, double depth) {
  const HeapSurface s =
      surface_of(in_contact(site, site.solver().particles()), site.cell(), p_edge.z());
  const int low = static_cast<int>((p_edge.y() + 0.25 * gap - s.origin.y()) / s.spacing),
            high = static_cast<int>((p_edge.y() + 0.75 * gap - s.origin.y()) / s.spacing);
  // A cell before the bed's end, where particles lean on resting ground.
  const double end = bed.ahead - p_edge.x() - site.cell();
  return [=](double x) {
    const int ix = static_cast<int>(std::lround((p_edge.x() + x - s.origin.x()) / s.spacing));
    if (x > end || ix < 0 || ix >= s.nx) return depth;
    double sum = 0;
    for (int iy = low; iy <= high; ++iy) sum += s.at(ix, iy) - p_edge.z();
    return sum / (high - low + 1);
  };
}

/// Compares the force of the last tenth of the travel with a wedge under the pile of that moment:
/// this shows whether force or pile differ from an experiment.
void read_pile(const Setup& setup, const ToolDriver& driver, const Site& site, const ChuteBed& bed,
               double gap, Report& report) {
  const double travel = setup["travel"], height = blade_height(setup), depth = setup["depth"];
  const BladeCase c = case_of(setup);
  const auto surface = profile(site, driver.pose().translation(), bed, gap, depth);
  // The last tenth: the pile hardly changes in it, so that force and pile belong together.
  const double end =
      -setup["width"] / gap * mean_force(driver.trace(), 0.9 * travel, 2 * travel).x();
  const double wedge = wedge_under(c, height, surface).horizontal;
  // A wide range: the plane wedge is an upper bound for a rough blade, and the law's zero dilatancy
  // reduces it.
  report
      .add("horizontal force at the end", end, "N", wedge, 0.75 * wedge, 1.25 * wedge,
           std::string("wedge under the pile as it lies [Coulomb 1776] ") + kSource)
      .holds_for(
          "a raked blade with tool friction that has gone three depths",
          setup["rake-deg"] < 89.9 && setup.soil.tool_friction_angle > 0 && travel > 2.99 * depth);
  report.note("at the end over its wedge", end / wedge, "");
  // From the blade's upper edge on; a quarter of a cell is the surface's own spacing.
  double top = 0;
  for (double x = -height / std::tan(c.rake); x < travel; x += site.cell() / 4)
    top = std::max(top, surface(x));
  report.note("top of the pile over the cutting edge", top, "m");
  // The formula is for a blade of finite length: without one, nothing rides up.
  if (setup["length"] > 0)
    report.add("horizontal force, against a riding layer", end, "N",
               riding_layer(c, setup["length"]).horizontal, kNone, kNone,
               "[Miedema 2014], largest force of a layer riding on the whole blade and beyond: an "
               "upper bound");
}

/// Adds the tools of a plane bed. A smooth blade and its side plates are one shell; a rough blade's
/// plates are another shell, without friction.
ToolDriver plane_tools(const Setup& setup, Site& site, const ChuteShape& shape, bool rough) {
  // Both shells start at one pose and have one twist: they stay together.
  const Pose start = make_pose(0, chute_offset(setup.cell), -setup["depth"]);
  if (!rough) return {site, blade_chute(shape), start};
  const int sides = site.add_tool(chute_sides(shape), start);
  ToolDriver driver(site, chute_blade(shape), start);
  driver.carry(sides);
  return driver;
}

/// Runs plane strain: the blade spans a chute. Forces are scaled to `width`.
Report run_plane(const Setup& setup) {
  const double cell = setup.cell, depth = setup["depth"], width = setup["width"],
               rake = radians(setup["rake-deg"]);
  // Soil that the blade never approaches still supports the wedge's foot.
  const double reach = setup["travel"] + setup["ahead"] * depth;
  const bool rough = setup.soil.tool_friction_angle > 0 || setup.soil.adhesion > 0;
  double share = 0;
  const double gap = rough ? chute_width(cell) : chute_gap(setup, share);
  const double below = whole_cells(depth * (1 + setup["below"]), cell);
  // Six cells behind the edge, for the soil that flows under it.
  const ChuteBed bed{6 * cell, cell * std::ceil(reach / cell), below};
  Site site(setup, chute_site(setup, bed, gap));
  ChuteShape shape;
  shape.half = chute_half(cell), shape.gap = gap, shape.rake = rake,
  shape.height = blade_height(setup),
  // Above the pile in front.
      shape.top = std::max(shape.height, 2.5 * depth) + (rough ? 2 * depth : 0);
  shape.back = bed.back + 3 * cell, shape.ahead = bed.ahead + 3 * cell,
  shape.bottom = depth - below - 2 * cell;
  const SiteBox box{Vec3(-bed.back, chute_offset(cell), -below),
                    Vec3(bed.ahead, chute_offset(cell) + gap, 0)};
  auto soil = site.fill(box, [&](const Vec3& p) { return ahead_of_blade(p, depth, rake, cell); });
  site.rest(soil, trench(depth));
  site.solver().insert(soil);
  ToolDriver driver = plane_tools(setup, site, shape, rough);
  const double speed = setup["speed"];
  site.expect((setup["travel"] + setup["ramp"]) / speed);
  driver.start(setup["travel"], Vec3(speed, 0, 0), setup["ramp"]);

  Report report;
  // The chute is a few cells wide; forces are given for the requested width.
  read_force(setup, driver, width / gap, reece_wedge(case_of(setup)), "[Reece 1964]", report);
  // The wedge under a pile is for dry soil and a blade that does not overhang.
  if (setup.soil.cohesion == 0 && setup.soil.adhesion == 0 && setup["rake-deg"] <= 90)
    read_pile(setup, driver, site, bed, gap, report);
  return finish_blade(site, driver, report);
}

/// Runs a blade of finite width in open ground.
Report run_open(const Setup& setup) {
  const double cell = setup.cell, depth = setup["depth"], width = setup["width"],
               rake = radians(setup["rake-deg"]);
  // Crescents reach about a depth to the side; the bed is twice as wide by default.
  const double side = width / 2 + setup["beside"] * depth;
  const double up = whole_cells(depth * (1 + setup["below"]), cell);
  const SiteBox bed{Vec3(-whole_cells(2 * depth, cell), -whole_cells(side, cell), -up),
                    Vec3(whole_cells(setup["travel"] + setup["ahead"] * depth, cell),
                         whole_cells(side, cell), 0)};
  SiteOptions options;
  options.size = 2 * (std::max(bed.high.x(), bed.high.y()) + 8 * cell);
  options.depth = up + 8 * cell;
  options.surface = pit(bed);
  Site site(setup, options);
  // The trench behind the blade is half a cell wider than the blade.
  auto soil = site.fill(bed, [&](const Vec3& p) {
    return std::abs(p.y()) > width / 2 + 0.5 * cell || ahead_of_blade(p, depth, rake, cell);
  });
  // At rest beside the trench, which is only as wide as the blade.
  site.rest(soil,
            [=](double x, double y) { return x > 0 || std::abs(y) > width / 2 ? 0.0 : -depth; });
  site.solver().insert(soil);
  scene::Shell shell = blade(width, blade_height(setup), rake);
  shell.half_thickness = setup["thick"] / 2;
  // The plate's face, not its mid-plane, starts at x = 0.
  ToolDriver driver(site, shell,
                    make_pose(-shell.half_thickness / std::sin(rake), 0.07 * cell, -depth));
  const double speed = setup["speed"];
  site.expect((setup["travel"] + setup["ramp"]) / speed);
  driver.start(setup["travel"], Vec3(speed, 0, 0), setup["ramp"]);
  Report report;
  read_force(setup, driver, 1, mckyes_ali(case_of(setup)), std::string("[McKyes 1977] ") + kSource,
             report);
  // The difference of the two is the effect of the crescents.
  report.add("2-D wedge alone", -mean_force(driver.trace(), setup["from"], setup["travel"]).x(),
             "N", reece_wedge(case_of(setup)).horizontal, kNone, kNone, "[Reece 1964]");
  return finish_blade(site, driver, report);
}

/// The two kinds of ground share the reading, not the bed.
Report run_blade(const Setup& setup) {
  return setup.is("plane", "yes") ? run_plane(setup) : run_open(setup);
}

const std::vector<Parameter> kBlade = {
    {"width", 1, "m", "of the blade; in plane strain forces are scaled to it", above(0)},
    {"depth", 0.3, "m", "of the cutting edge under the ground", above(0)},
    {"rake-deg", 90, "deg", "of the blade's face with the ground ahead, 90 is upright",
     between(15, 150)},
    {"speed", 0.3, "m/s", "ahead", above(0)},
    {"from", 0.03, "m", "of travel at which the mean begins", above(0)},
    {"travel", 0.07, "m", "at which it ends", above(0)},
    {"ramp", 0.015, "m", "of travel over which it accelerates; 0: at once", at_least(0)},
    yes_no("plane", true, "plane strain between smooth plates",
           "a blade of its width in open ground"),
    {"ahead", 3, "depths", "of soil in front after the travel", at_least(0)},
    {"beside", 2, "depths", "of soil on either side (open ground)", at_least(0)},
    {"below", 1, "depths", "of soil under the cutting edge", at_least(0)},
    {"thick", 0.01, "m",
     "of the plate in open ground; in plane strain it is half a cell and only its face counts",
     above(0)},
    {"above", 1, "depths", "of the blade over the ground", above(0)},
    {"length", 0, "m", "of the blade along its face; 0: its height follows from `above`",
     at_least(0)},
    {"expected-n", 0, "N", "a measured force for comparison instead of the formula; 0: none",
     at_least(0)},
    {"tolerance-percent",
     15,
     "%",
     "of the expected force; 0: no tolerance",
     at_least(0),
     {},
     "gate-percent"}};

}  // namespace

Rig blade_rig() {
  Rig rig;
  rig.name = "blade";
  rig.summary =
      "flat blade pushed through the ground: force compared with wedge theory or an experiment";
  rig.drawing =
      "A plate with its cutting edge `depth` under level ground, with an open trench behind it, "
      "moves ahead at `speed`. The force is the mean of the soil's impulses while the travel is "
      "between `from` and `travel`. `plane` yes: the plate spans a chute of smooth side plates "
      "that travel with it, 5 cells wide, 8 with tool friction. In soil without cohesion the "
      "force of the last tenth of the travel is compared with Coulomb's wedge under the pile of "
      "that moment; with `length`, Miedema's layer that rides on the whole blade is an upper "
      "bound. Tolerances: an upright smooth blade Rankine, a rough one 0.95 of the lower bound "
      "(slip lines; weight by Lancellotta) to 1.05 of the log spiral (Caquot and Kerisel). "
      "Reece's planar wedge is an upper bound and only listed. Soil that softens is compared with "
      "its residual cohesion, without a tolerance. `plane` no: open ground, with McKyes and Ali "
      "for comparison.";
  rig.examples = {{"Narrow blade in washed sand [Obermayr 2011]; depths 0.10, 0.15, 0.20, 0.25 m "
                   "measured 280, 505, 820, 1310 N",
                   "--plane no --width 0.2 --depth 0.10 --density 1440 --phi-deg 35 --delta-deg "
                   "16.2 --speed 0.45 --from 0.5 "
                   "--travel 1.5 --expected-n 280 --tolerance-percent 25 --cell 0.05"},
                  {"Raked blade in sand [Hatamura 1977]; the formula of [Miedema 2014] for the "
                   "largest force gives 259, 400, 605 N "
                   "at rakes of 30, 45, 60",
                   "--width 0.33 --length 0.20 --rake-deg 30 --phi-deg 38 --delta-deg 26.6 "
                   "--density 1460 --depth 0.10 --cell "
                   "0.033 --ahead 4 --tolerance-percent 0 --speed 0.05 --from 0.4 --travel 0.5"},
                  {"The same six times as fast, with a fully developed pile",
                   "--width 0.33 --length 0.20 --rake-deg 30 --phi-deg 38 --delta-deg 26.6 "
                   "--density 1460 --depth 0.10 --cell "
                   "0.033 --ahead 4 --tolerance-percent 0 --speed 0.3 --from 1.0 --travel 1.5"},
                  {"Three speeds and two steps in one table, with a plot",
                   "--speed 0.05,0.15,0.3 --courant 0.5,0.25 --cell 0.05 --plot blade.svg"}};
  rig.parameters = kBlade;
  rig.default_soil = clean_sand(35);
  rig.default_soil.tool_friction_angle = 0;
  rig.headline = {"horizontal over expected", "horizontal force", "peak over expected",
                  "at the end over its wedge", "scatter of the force"};
  rig.experiment = run_blade;
  return rig;
}

}  // namespace navvy::lab
