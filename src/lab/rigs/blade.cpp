// SPDX-License-Identifier: Apache-2.0
// Rigs `blade` and `wall`: a flat plate pushed into the ground or drawn back from it.
//
// A blade in plane strain is the digging force in its purest form: a wedge slides up between blade and rupture plane,
// and its equilibrium gives the force in closed form. Smooth and upright it is Rankine's passive pressure, exactly.
// A rough or flat blade lifts soil that piles up and rides on it, so that the force grows with the travel. Then it is
// held against a wedge under the pile as it lies, which tells errors of force from errors of the pile's shape. A narrow
// blade in open ground carries crescents at its sides besides.
// The wall is the same plate as high as the soil, moved little: active when drawn away, passive when pushed in.
#include <algorithm>
#include <cmath>

#include "lab/rigs/chute.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/shapes.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Blades and earth pressure]";

/// What the formulas are asked, of the setup's soil. `depth` and `width` are the caller's: a wall has a height.
BladeCase blade_case(const Setup& setup, double depth, double width) {
  const scene::Soil& s = setup.soil;
  BladeCase out;
  out.phi = s.friction_angle, out.delta = s.tool_friction_angle, out.rake = radians(setup["rake-deg"]);
  out.depth = depth, out.width = width;
  out.unit_weight = s.bank_density * kGravity, out.cohesion = s.cohesion, out.adhesion = s.adhesion;
  return out;
}

/// Of the blade's upper edge over its lip [m].
double blade_height(const Setup& setup) {
  const double length = setup["length"];
  return length > 0 ? length * std::sin(radians(setup["rake-deg"])) : setup["depth"] * (1 + setup["above"]);
}

/// Inside the ground and not in the trench that stands open behind a blade's face, lip at x = 0. The lattice of
/// particles begins a quarter of a cell ahead of an upright face.
bool ahead_of_blade(const Vec3& p, double depth, double rake, double cell) {
  // Under the lip everything is soil; over it only what lies ahead of the face.
  return p.z() < -depth || p.x() + (p.z() + depth) / std::tan(rake) > 0.1 * cell / std::sin(rake);
}

/// The surface for the stress at rest.
std::function<double(double, double)> trench(double depth) {
  return [depth](double x, double) { return x > 0 ? 0.0 : -depth; };
}

/// What both kinds of bed read off the trace.
void read_force(const Setup& setup, const ToolDriver& driver, double scale, const BladeForce& formula,
                const std::string& source, Report& report) {
  const double from = setup["from"], to = setup["travel"];
  // One window for mean and scatter, the one that an experiment states.
  const Vec3 force = scale * mean_force(driver.trace(), from, to),
             scatter = scale * force_scatter(driver.trace(), from, to);
  const double given = setup["expected-n"];
  const double expected = given > 0 ? given : formula.horizontal;
  // A measured force replaces the formula; the formula then stands beside it without a gate.
  const double gate = setup["gate-percent"] / 100;
  const bool slippery = setup.soil.tool_friction_angle == 0 && setup.soil.adhesion == 0;
  const bool rankine = slippery && setup.is("plane", "yes") && std::abs(setup["rake-deg"] - 90) < 1e-6;
  report
      .add("horizontal force", -force.x(), "N", expected, gate > 0 ? (1 - gate) * expected : kNone,
           gate > 0 ? (1 + gate) * expected : kNone,
           given > 0 ? std::string("--expected-n, of the experiments ") + kSource : source)
      .holds_for("a smooth upright blade in plane strain, or a force given by --expected-n", rankine || given > 0);
  if (given > 0)
    report.add("horizontal force, against the formula", -force.x(), "N", formula.horizontal, kNone, kNone, source);
  report.add("vertical force on the blade, down", -force.z(), "N", formula.vertical, kNone, kNone, source);
  // One number to compare runs of other soils and depths by.
  report.note("horizontal over expected", -force.x() / expected, "");
  report.note("scatter of the force", 100 * scatter.x() / std::abs(force.x()), "%",
              "rms about the mean over its window");
  double peak = 0;
  // Passing two cells of soil takes 2 cell / v: faster changes are the grid's, not the soil's.
  const auto smooth = [&] {
    std::vector<double> x;
    for (const Vec3& f : driver.trace().force) x.push_back(-scale * f.x());
    return low_pass(driver.trace().time, x, std::max(1.0, setup["speed"] / (2 * setup.cell)));
  }();
  for (const double x : smooth) peak = std::max(peak, x);
  report.note("peak, low-passed at v / (2 cells)", peak, "N");
}

Report finish(Site& site, const ToolDriver& driver, Report report) {
  report.add("particles through the blade", static_cast<double>(site.solver().stats().shell_crossings), "", 0, kNone, 0,
             std::string("none may pass; summed over steps ") + kSource);
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  driver.write(report, 20);
  site.finish(report);
  return report;
}

/// Height over the lip [m] of what lies at x ahead of it, mean over the middle half of the chute. Beyond the
/// bed's end the ground rests, `depth` over the lip.
std::function<double(double)> profile(const Site& site, const Vec3& p_lip, const ChuteBed& bed, double gap,
                                      double depth) {
  const HeapSurface s = surface_of(in_contact(site, site.solver().particles()), site.cell(), p_lip.z());
  const int low = static_cast<int>((p_lip.y() + 0.25 * gap - s.origin.y()) / s.spacing),
            high = static_cast<int>((p_lip.y() + 0.75 * gap - s.origin.y()) / s.spacing);
  // A cell short of the bed's end, where particles lean on resting ground.
  const double end = bed.ahead - p_lip.x() - site.cell();
  return [=](double x) {
    const int ix = static_cast<int>(std::lround((p_lip.x() + x - s.origin.x()) / s.spacing));
    if (x > end || ix < 0 || ix >= s.nx) return depth;
    double sum = 0;
    for (int iy = low; iy <= high; ++iy) sum += s.at(ix, iy) - p_lip.z();
    return sum / (high - low + 1);
  };
}

/// Holds the force of the last tenth of the travel against a wedge under the pile as it lies then: whether it is the
/// force or the pile that differs from an experiment.
void read_pile(const Setup& setup, const ToolDriver& driver, const Site& site, const ChuteBed& bed, double gap,
               Report& report) {
  const double travel = setup["travel"], height = blade_height(setup), depth = setup["depth"];
  const BladeCase c = blade_case(setup, depth, setup["width"]);
  const auto surface = profile(site, driver.pose().translation(), bed, gap, depth);
  // The last tenth: the pile hardly changes in it, so that force and pile belong together.
  const double end = -setup["width"] / gap * mean_force(driver.trace(), 0.9 * travel, 2 * travel).x();
  report.add("horizontal force at the end", end, "N", wedge_under(c, height, surface).horizontal, kNone, kNone,
             "wedge under the pile as it lies [Coulomb 1776]");
  // From the blade's upper edge on; a quarter of a cell is the surface's own spacing.
  double top = 0;
  for (double x = -height / std::tan(c.rake); x < travel; x += site.cell() / 4) top = std::max(top, surface(x));
  report.note("top of the pile over the lip", top, "m");
  // The formula is for a blade of its own length: without one there is nothing to ride up.
  if (setup["length"] > 0)
    report.add("horizontal force, against a riding layer", end, "N", riding_layer(c, setup["length"]).horizontal, kNone,
               kNone, "[Miedema 2014], largest force of a layer riding on the whole blade and beyond");
}

/// The tools of a plane bed. A smooth blade and its side plates are one shell; a rough blade's plates are another
/// shell, without friction.
ToolDriver plane_tools(const Setup& setup, Site& site, const ChuteShape& shape, bool rough) {
  // Both shells start at one pose and have one twist: they stay together.
  const Pose start = make_pose(0, chute_offset(setup.cell), -setup["depth"]);
  if (rough) site.tool(site.add_tool(chute_sides(shape), start)).motion.v_WT = Vec3(setup["speed"], 0, 0);
  return {site, rough ? chute_blade(shape) : blade_chute(shape), start};
}

/// Plane strain: the blade spans a chute. Forces are scaled to `width`.
Report run_plane(const Setup& setup) {
  const double cell = setup.cell, depth = setup["depth"], width = setup["width"], rake = radians(setup["rake-deg"]);
  // Soil that the blade never comes near still carries the wedge's foot.
  const double reach = setup["travel"] + setup["ahead"] * depth;
  const bool rough = setup.soil.tool_friction_angle > 0 || setup.soil.adhesion > 0;
  double share = 0;
  const double gap = rough ? chute_width(cell) : chute_gap(setup, share);
  const double below = whole_cells(depth * (1 + setup["below"]), cell);
  // Six cells behind the lip: what flows under it must have somewhere to lie.
  const ChuteBed bed{6 * cell, cell * std::ceil(reach / cell), below};
  SiteOptions options = chute_site(setup, bed, gap);
  options.courant = setup["courant"];
  Site site(setup, options);
  ChuteShape shape;
  shape.half = chute_half(cell), shape.gap = gap, shape.rake = rake, shape.height = blade_height(setup),
  shape.top = std::max(shape.height, 2.5 * depth) + (rough ? 2 * depth : 0);  // over what piles up in front
  shape.back = bed.back + 3 * cell, shape.ahead = bed.ahead + 3 * cell, shape.bottom = depth - below - 2 * cell;
  const Box box{Vec3(-bed.back, chute_offset(cell), -below), Vec3(bed.ahead, chute_offset(cell) + gap, 0)};
  auto soil = site.fill(box, [&](const Vec3& p) { return ahead_of_blade(p, depth, rake, cell); });
  site.rest(soil, trench(depth));
  site.solver().insert(soil);
  ToolDriver driver = plane_tools(setup, site, shape, rough);
  const double speed = setup["speed"];
  site.expect(setup["travel"] / speed);
  driver.advance(setup["travel"], Vec3(speed, 0, 0));

  Report report;
  // The chute is a few cells wide; forces are given for the width asked for.
  read_force(setup, driver, width / gap, reece_wedge(blade_case(setup, depth, width)),
             std::string("[Reece 1964], smooth and upright [Rankine 1857] ") + kSource, report);
  // The wedge under a pile is for dry soil and a blade that does not overhang.
  if (setup.soil.cohesion == 0 && setup.soil.adhesion == 0 && setup["rake-deg"] <= 90)
    read_pile(setup, driver, site, bed, gap, report);
  return finish(site, driver, report);
}

/// A blade of finite width in open ground.
Report run_open(const Setup& setup) {
  const double cell = setup.cell, depth = setup["depth"], width = setup["width"], rake = radians(setup["rake-deg"]);
  // Crescents reach about a depth to the side; the bed is twice as wide by default.
  const double side = width / 2 + setup["beside"] * depth;
  const double up = whole_cells(depth * (1 + setup["below"]), cell);
  const Box bed{Vec3(-whole_cells(2 * depth, cell), -whole_cells(side, cell), -up),
                Vec3(whole_cells(setup["travel"] + setup["ahead"] * depth, cell), whole_cells(side, cell), 0)};
  SiteOptions options;
  options.size = 2 * (std::max(bed.high.x(), bed.high.y()) + 8 * cell);
  options.depth = up + 8 * cell;
  options.surface = pit(bed);
  options.courant = setup["courant"];
  Site site(setup, options);
  // The trench behind the blade is as wide as the blade and half a cell more.
  auto soil = site.fill(bed, [&](const Vec3& p) {
    return std::abs(p.y()) > width / 2 + 0.5 * cell || ahead_of_blade(p, depth, rake, cell);
  });
  // At rest beside the trench as everywhere: the trench is as wide as the blade only.
  site.rest(soil, [=](double x, double y) { return x > 0 || std::abs(y) > width / 2 ? 0.0 : -depth; });
  site.solver().insert(soil);
  scene::Shell shell = blade(width, blade_height(setup), rake);
  shell.half_thickness = setup["thick"] / 2;
  // The plate's face, not its middle, starts at x = 0.
  ToolDriver driver(site, shell, make_pose(-shell.half_thickness / std::sin(rake), 0.07 * cell, -depth));
  const double speed = setup["speed"];
  site.expect(setup["travel"] / speed);
  driver.advance(setup["travel"], Vec3(speed, 0, 0));
  Report report;
  read_force(setup, driver, 1, mckyes_ali(blade_case(setup, depth, width)), std::string("[McKyes 1977] ") + kSource,
             report);
  // What the crescents add shows in the difference of the two.
  report.add("2-D wedge alone", -mean_force(driver.trace(), setup["from"], setup["travel"]).x(), "N",
             reece_wedge(blade_case(setup, depth, width)).horizontal, kNone, kNone, "[Reece 1964]");
  return finish(site, driver, report);
}

/// The two kinds of ground share the reading, not the bed.
Report run_blade(const Setup& setup) { return setup.is("plane", "yes") ? run_plane(setup) : run_open(setup); }

// The wall.

/// Force per metre at three stages: before it moves, at its least (active) or over the last fifth (passive).
Report run_wall(const Setup& setup) {
  const double cell = setup.cell, height = setup["height"], speed = setup["speed"], travel = setup["travel"] * height;
  const bool passive = setup["travel"] > 0;
  double share = 0;
  const double gap = chute_gap(setup, share);
  const double below = whole_cells(height * (1 + setup["below"]), cell);
  // Older than the chute of blades and kept for its numbers: a rough wall is rough over the middle of the chute only,
  // with smooth soil against the plates.
  const ChuteBed bed{6 * cell, cell * std::ceil((std::abs(travel) + setup["ahead"] * height) / cell), below};
  Site site(*setup.device, chute_soils(setup.soil), cell, chute_site(setup, bed, gap));
  ChuteShape shape;
  shape.half = chute_half(cell), shape.gap = gap, shape.height = shape.top = height + 4 * cell;
  shape.back = bed.back + 3 * cell, shape.ahead = bed.ahead + 3 * cell + std::abs(travel),
  shape.bottom = height - below - 2 * cell;
  site.solver().insert(chute_fill(
      site, bed, gap, share > 0, [&](const Vec3& p) { return ahead_of_blade(p, height, kPi / 2, cell); },
      trench(height)));
  ToolDriver driver(site, blade_chute(shape), make_pose(0, chute_offset(cell), -height));
  // The wall's way either way.
  const double seconds = std::abs(travel) / speed;
  site.expect(setup["wait"] + seconds);
  driver.run(0.7 * setup["wait"]);
  // The last third of the wait, after the start has rung out.
  const double at_rest = -driver.run(0.3 * setup["wait"]).x() / gap;
  driver.set_twist(Vec3(passive ? speed : -speed, 0, 0));
  driver.run(0.8 * seconds);
  // The last fifth: the pressure has reached its limit there, when the soil is stiff enough.
  const Vec3 last = -driver.run(0.2 * seconds) / gap;

  const scene::Soil& s = setup.soil;
  const double weight = s.bank_density * kGravity, k0 = s.poisson / (1 - s.poisson);
  // Rankine's wall is smooth; a rough one is held against it for comparison, without a gate.
  const double expected = passive ? rankine_passive_force(s.friction_angle, s.cohesion, weight, height)
                                  : rankine_active_force(s.friction_angle, s.cohesion, weight, height);
  Report report;
  report.add("force at rest", at_rest, "N/m", 0.5 * weight * height * height * k0, kNone, kNone,
             "K0 = nu / (1 - nu), elastic rest");
  const bool gated = share == 0;
  const double far = passive ? 0.1999 : 0.0299, moved = std::abs(travel) / height;
  report
      .add(passive ? "passive force" : "active force", last.x(), "N/m", expected, gated ? 0.9 * expected : kNone,
           gated ? 1.1 * expected : kNone, std::string("[Rankine 1857] [docs/validation.md, Slopes, walls and cuts]"))
      .holds_for("a smooth wall, E of 4 MPa or more, moved by 0.2 H in or 0.03 H out",
                 gated && s.young_modulus > 3.99e6 && moved > far);
  // Ka or Kp as a textbook tabulates them.
  if (gated) report.note("coefficient", last.x() / (0.5 * weight * height * height), "", "of 0.5 gamma H2");
  if (!gated && passive) {
    // By widths: the smooth part of the wall is Rankine's, the rough part the wedge's.
    BladeCase rough = blade_case(setup, height, 1), smooth = rough;
    smooth.delta = smooth.adhesion = 0;
    const double wedge = (1 - share) * reece_wedge(smooth).horizontal + share * reece_wedge(rough).horizontal;
    report.add("passive force, rough wall", last.x(), "N/m", wedge, kNone, kNone,
               "[Reece 1964], planar wedge: an upper bound");
  }
  report.add("vertical over horizontal", last.z() / last.x(), "",
             passive ? share * std::tan(s.tool_friction_angle) : kNone, kNone, kNone,
             "tan delta times the rough share");
  return finish(site, driver, report);
}

const std::vector<Parameter> kBlade = {
    {"width", 1, "m", "of the blade; in plane strain forces are scaled to it", above(0)},
    {"depth", 0.3, "m", "of the lip under the ground", above(0)},
    {"rake-deg", 90, "deg", "of the blade's face with the ground ahead, 90 is upright", between(15, 150)},
    {"speed", 0.3, "m/s", "ahead", above(0)},
    {"courant", 0.5, "", "step as a share of cell / sound speed", between(0.05, 0.65)},
    {"from", 0.03, "m", "of travel at which the mean begins", above(0)},
    {"travel", 0.07, "m", "at which it ends", above(0)},
    yes_no("plane", true, "plane strain between smooth plates", "a blade of its width in open ground"),
    {"ahead", 3, "depths", "of soil in front after the travel", at_least(0)},
    {"beside", 2, "depths", "of soil on either side (open ground)", at_least(0)},
    {"below", 1, "depths", "of soil under the lip", at_least(0)},
    {"thick", 0.01, "m", "of the plate in open ground; in plane strain it is half a cell and only its face counts",
     above(0)},
    {"above", 1, "depths", "of blade over the ground", above(0)},
    {"length", 0, "m", "of the blade from its lip along its face; 0: as high as `above` says", at_least(0)},
    {"expected-n", 0, "N", "a measured force to be held against instead of the formula; 0: none", at_least(0)},
    {"gate-percent", 15, "%", "of the expected force; 0: no gate", at_least(0)}};

}  // namespace

Rig blade_rig() {
  Rig rig;
  rig.name = "blade";
  rig.summary = "flat blade pushed through the ground: force against wedge theory or an experiment";
  rig.drawing =
      "A plate with its lip `depth` under level ground, a trench open behind it, moves ahead at `speed`. The force is "
      "the mean of the soil's impulses while the travel is between `from` and `travel`. `plane` yes: the plate spans "
      "a chute of smooth side plates that travel with it, 5 cells wide, 8 with tool friction. In soil without "
      "cohesion the force of the last tenth of the travel is held against Coulomb's wedge under the pile as it lies "
      "then; with `length` against Miedema's layer that rides on the whole blade too. No: open ground, expected "
      "McKyes and Ali.";
  rig.examples = {
      {"Narrow blade in washed sand [Obermayr 2011]; depths 0.10, 0.15, 0.20, 0.25 m measured 280, 505, 820, 1310 N",
       "--plane no --width 0.2 --depth 0.10 --density 1440 --phi-deg 35 --delta-deg 16.2 --speed 0.45 --from 0.5 "
       "--travel 1.5 --expected-n 280 --gate-percent 25 --cell 0.05"},
      {"Raked blade in sand [Hatamura 1977], held against the formula of [Miedema 2014]; rakes 30, 45, 60 give 259, "
       "400, 605 N",
       "--width 0.33 --length 0.20 --rake-deg 30 --phi-deg 38 --delta-deg 26.6 --density 1460 --depth 0.10 --cell "
       "0.033 --ahead 4 --expected-n 259 --gate-percent 30 --speed 0.05 --from 0.4 --travel 0.5"},
      {"The same six times as fast, its pile full grown",
       "--width 0.33 --length 0.20 --rake-deg 30 --phi-deg 38 --delta-deg 26.6 --density 1460 --depth 0.10 --cell "
       "0.033 --ahead 4 --gate-percent 0 --speed 0.3 --from 1.0 --travel 1.5"}};
  rig.parameters = kBlade;
  rig.default_soil = clean_sand(35);
  rig.default_soil.tool_friction_angle = 0;
  rig.experiment = run_blade;
  return rig;
}

Rig wall_rig() {
  Rig rig;
  rig.name = "wall";
  rig.summary = "retaining wall: active and passive earth pressure against Rankine";
  rig.drawing =
      "An upright wall of `height` holds level soil; the soil goes on under its toe. After `wait` it moves `travel` "
      "heights: towards the soil when positive (passive), away when negative (active). Plane strain: the wall spans a "
      "chute of smooth side plates. The force at rest is the mean of the last third of the wait, the other the mean "
      "over the last fifth of the travel. With tool friction (--delta-deg) the wall is rough over its middle two "
      "thirds.";
  rig.examples = {{"Active pressure", "--travel -0.03"}};
  rig.parameters = {{"height", 1, "m", "of the wall", above(0)},
                    {"travel", 0.2, "heights", "positive: passive, negative: active", any()},
                    {"speed", 0.1, "m/s", "of the wall", above(0)},
                    {"wait", 0.3, "s", "at rest before it moves", at_least(0)},
                    {"rake-deg", 90, "deg", "for the wedge formula", between(15, 150)},
                    {"ahead", 3, "heights", "of soil in front", at_least(0)},
                    {"below", 0.5, "heights", "of soil under the toe", at_least(0)}};
  rig.default_soil = clean_sand(35);
  rig.default_soil.tool_friction_angle = 0;
  rig.default_soil.young_modulus = 4e6;  // at 1 MPa a passive wall needs more than a fifth of its height of travel
  rig.experiment = run_wall;
  return rig;
}

}  // namespace navvy::lab
