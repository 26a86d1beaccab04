// SPDX-License-Identifier: Apache-2.0
// Rigs `blade` and `wall`: a flat plate pushed into the ground or drawn back from it.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "lab/rigs/chute.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/tool_list.h"
#include "lab/shapes.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

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
  return p.z() < -depth || p.x() + (p.z() + depth) / std::tan(rake) > 0.1 * cell / std::sin(rake);
}

/// The surface for the stress at rest.
std::function<double(double, double)> trench(double depth) {
  return [depth](double x, double) { return x > 0 ? 0.0 : -depth; };
}

void check_cut(const Setup& setup) {
  const double rake = setup["rake-deg"];
  if (rake < 15 || rake > 150)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "rake-deg", std::to_string(rake), "15 .. 150 degrees",
                           "90 is an upright blade"});
}

/// What both kinds of bed read off the trace.
void read_force(const Setup& setup, const ToolDriver& driver, double scale, const BladeForce& formula,
                const std::string& source, Report& report) {
  const double from = setup["from"], to = setup["travel"];
  const Vec3 force = scale * mean_force(driver.trace(), from, to),
             scatter = scale * force_scatter(driver.trace(), from, to);
  const double given = setup["expected-n"];
  const double expected = given > 0 ? given : formula.horizontal;
  const double gate = setup["gate-percent"] / 100;
  report.add("horizontal force", -force.x(), "N", expected, gate > 0 ? (1 - gate) * expected : kNone,
             gate > 0 ? (1 + gate) * expected : kNone, given > 0 ? "given" : source);
  if (given > 0)
    report.add("horizontal force, against the formula", -force.x(), "N", formula.horizontal, kNone, kNone, source);
  report.add("vertical force on the blade, down", -force.z(), "N", formula.vertical, kNone, kNone, source);
  report.note("horizontal over expected", -force.x() / expected, "");
  report.note("scatter of the force", 100 * scatter.x() / std::abs(force.x()), "%",
              "rms about the mean over its window");
  double peak = 0;
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
             "none may pass; summed over steps");
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  driver.write(report, 20);
  site.finish(report);
  return report;
}

/// Height over the lip [m] of what lies at x ahead of it, mean over the middle half of the chute. Beyond the
/// bed's end the ground rests, `depth` over the lip.
std::function<double(double)> profile(const Site& site, const Vec3& p_lip, const ChuteBed& bed, double gap,
                                      double depth) {
  const Surface s = surface_of(in_contact(site, site.solver().particles()), site.cell(), p_lip.z());
  const int low = static_cast<int>((p_lip.y() + 0.25 * gap - s.origin.y()) / s.spacing),
            high = static_cast<int>((p_lip.y() + 0.75 * gap - s.origin.y()) / s.spacing);
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
  const double end = -setup["width"] / gap * mean_force(driver.trace(), 0.9 * travel, 2 * travel).x();
  report.add("horizontal force at the end", end, "N", wedge_under(c, height, surface).horizontal, kNone, kNone,
             "Coulomb's wedge under the pile as it lies");
  double top = 0;
  for (double x = -height / std::tan(c.rake); x < travel; x += site.cell() / 4) top = std::max(top, surface(x));
  report.note("top of the pile over the lip", top, "m");
  if (setup["length"] > 0)
    report.add("horizontal force, against a riding layer", end, "N", riding_layer(c, setup["length"]).horizontal, kNone,
               kNone, "Miedema 2015: largest force of a layer riding on the whole blade and beyond");
}

/// The tools of a plane bed. A smooth blade and its side plates are one shell; a rough blade's plates are another
/// shell, without friction.
ToolDriver plane_tools(const Setup& setup, Site& site, const ChuteShape& shape, bool rough) {
  const Pose start = make_pose(0, chute_offset(setup.cell), -setup["depth"]);
  if (rough) site.tool(site.add_tool(chute_sides(shape), start)).motion.v_WT = Vec3(setup["speed"], 0, 0);
  return {site, rough ? chute_blade(shape) : blade_chute(shape), start};
}

/// Plane strain: the blade spans a chute. Forces are scaled to `width`.
Report run_plane(const Setup& setup) {
  const double cell = setup.cell, depth = setup["depth"], width = setup["width"], rake = radians(setup["rake-deg"]);
  const double reach = setup["travel"] + setup["ahead"] * depth;
  const bool rough = setup.soil.tool_friction_angle > 0 || setup.soil.adhesion > 0;
  double share = 0;
  const double gap = rough ? chute_width(cell) : chute_gap(setup, share);
  const double below = cell * std::ceil((depth * (1 + setup["below"])) / cell - 1e-9);
  const ChuteBed bed{6 * cell, cell * std::ceil(reach / cell), below};
  Site site(setup, chute_site(setup, bed, gap));
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
  read_force(setup, driver, width / gap, reece_wedge(blade_case(setup, depth, width)),
             "Reece 1964 (smooth and upright: Rankine); VALIDATION 3", report);
  if (setup.soil.cohesion == 0 && setup.soil.adhesion == 0 && setup["rake-deg"] <= 90)
    read_pile(setup, driver, site, bed, gap, report);
  return finish(site, driver, report);
}

/// A blade of finite width in open ground.
Report run_open(const Setup& setup) {
  const double cell = setup.cell, depth = setup["depth"], width = setup["width"], rake = radians(setup["rake-deg"]);
  const double side = width / 2 + setup["beside"] * depth;
  const double up = cell * std::ceil((depth * (1 + setup["below"])) / cell - 1e-9);
  const auto whole = [cell](double x) { return cell * std::ceil(x / cell - 1e-9); };
  const Box bed{Vec3(-whole(2 * depth), -whole(side), -up),
                Vec3(whole(setup["travel"] + setup["ahead"] * depth), whole(side), 0)};
  SiteOptions options;
  options.size = 2 * (std::max(bed.high.x(), bed.high.y()) + 8 * cell);
  options.depth = up + 8 * cell;
  options.surface = pit(bed);
  Site site(setup, options);
  auto soil = site.fill(bed, [&](const Vec3& p) {
    return std::abs(p.y()) > width / 2 + 0.5 * cell || ahead_of_blade(p, depth, rake, cell);
  });
  site.rest(soil, [=](double x, double y) { return x > 0 || std::abs(y) > width / 2 ? 0.0 : -depth; });
  site.solver().insert(soil);
  scene::Shell shell = blade(width, blade_height(setup), rake);
  shell.half_thickness = setup["thick"] / 2;
  ToolDriver driver(site, shell, make_pose(-shell.half_thickness / std::sin(rake), 0.07 * cell, -depth));
  const double speed = setup["speed"];
  site.expect(setup["travel"] / speed);
  driver.advance(setup["travel"], Vec3(speed, 0, 0));
  Report report;
  read_force(setup, driver, 1, mckyes_ali(blade_case(setup, depth, width)), "McKyes and Ali 1977; VALIDATION 3",
             report);
  report.add("2-D wedge alone", -mean_force(driver.trace(), setup["from"], setup["travel"]).x(), "N",
             reece_wedge(blade_case(setup, depth, width)).horizontal, kNone, kNone, "Reece 1964");
  return finish(site, driver, report);
}

Report run_blade(const Setup& setup) {
  check_cut(setup);
  return setup.whole("plane") == 1 ? run_plane(setup) : run_open(setup);
}

// The wall.

/// Force per metre at three stages: before it moves, at its least (active) or over the last fifth (passive).
Report run_wall(const Setup& setup) {
  const double cell = setup.cell, height = setup["height"], speed = setup["speed"], travel = setup["travel"] * height;
  const bool passive = setup["travel"] > 0;
  double share = 0;
  const double gap = chute_gap(setup, share);
  const double below = cell * std::ceil(height * (1 + setup["below"]) / cell - 1e-9);
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
  const double seconds = std::abs(travel) / speed;
  site.expect(setup["wait"] + seconds);
  driver.run(0.7 * setup["wait"]);
  const double at_rest = -driver.run(0.3 * setup["wait"]).x() / gap;
  driver.set_twist(Vec3(passive ? speed : -speed, 0, 0));
  driver.run(0.8 * seconds);
  const Vec3 last = -driver.run(0.2 * seconds) / gap;

  const scene::Soil& s = setup.soil;
  const double weight = s.bank_density * kGravity, k0 = s.poisson / (1 - s.poisson);
  const double expected = passive ? rankine_passive_force(s.friction_angle, s.cohesion, weight, height)
                                  : rankine_active_force(s.friction_angle, s.cohesion, weight, height);
  Report report;
  report.add("force at rest", at_rest, "N/m", 0.5 * weight * height * height * k0, kNone, kNone, "K0 = nu / (1 - nu)");
  const bool gated = share == 0;
  report.add(passive ? "passive force" : "active force", last.x(), "N/m", expected, gated ? 0.9 * expected : kNone,
             gated ? 1.1 * expected : kNone, gated ? "Rankine; VALIDATION 1" : "Rankine, smooth wall: for comparison");
  if (gated) report.note("coefficient", last.x() / (0.5 * weight * height * height), "", "of 0.5 gamma H2");
  if (!gated && passive) {
    BladeCase rough = blade_case(setup, height, 1), smooth = rough;
    smooth.delta = smooth.adhesion = 0;
    const double wedge = (1 - share) * reece_wedge(smooth).horizontal + share * reece_wedge(rough).horizontal;
    report.add("passive force, rough wall", last.x(), "N/m", wedge, kNone, kNone,
               "Reece 1964, planar wedge: an upper bound");
  }
  report.add("vertical over horizontal", last.z() / last.x(), "",
             passive ? share * std::tan(s.tool_friction_angle) : kNone, kNone, kNone,
             "tan delta times the rough share");
  return finish(site, driver, report);
}

const std::vector<Parameter> kBlade = {
    {"width", 1, "m", "of the blade; with plane 1 forces are scaled to it"},
    {"depth", 0.3, "m", "of the lip under the ground"},
    {"rake-deg", 90, "deg", "of the blade's face with the ground ahead; 90 is upright"},
    {"speed", 0.3, "m/s", "ahead"},
    {"from", 0.03, "m", "of travel at which the mean begins"},
    {"travel", 0.07, "m", "at which it ends"},
    {"plane", 1, "", "1: plane strain between smooth plates; 0: a blade of its width in open ground"},
    {"ahead", 3, "depths", "of soil in front after the travel"},
    {"beside", 2, "depths", "of soil on either side (plane 0)"},
    {"below", 1, "depths", "of soil under the lip"},
    {"thick", 0.01, "m", "of the plate (plane 0; plane 1: half a cell, only its face counts)"},
    {"above", 1, "depths", "of blade over the ground"},
    {"length", 0, "m", "of the blade from its lip along its face; 0: as high as `above` says"},
    {"expected-n", 0, "N", "a measured force to be held against instead of the formula; 0: none"},
    {"gate-percent", 15, "%", "of the expected force; 0: no gate"}};

}  // namespace

Rig blade() {
  Rig rig;
  rig.name = "blade";
  rig.summary = "flat blade pushed through the ground: force against wedge theory or an experiment";
  rig.drawing =
      "A plate with its lip `depth` under level ground, a trench open behind it, moves ahead at `speed`. The force is "
      "the mean of the soil's impulses while the travel is between `from` and `travel`. Plane 1: the plate spans a "
      "chute of smooth side plates that travel with it, 5 cells wide, 8 with tool friction. In soil without cohesion "
      "the force of the last tenth of the travel is held against Coulomb's wedge under the pile as it lies then; with "
      "`length` against Miedema's layer that rides on the whole blade too. Plane 0: open ground, expected McKyes and "
      "Ali. Obermayr 2011: --plane 0 --width 0.2 --depth 0.10 (0.15 0.20 0.25) --density 1440 --phi-deg 35 --delta-deg "
      "16.2 --speed 0.45 --from 0.5 --travel 1.5 --expected-n 280 (505 820 1310) --gate-percent 25 --cell 0.05. "
      "Hatamura 1977, held against Miedema's formula: --width 0.33 --length 0.20 --rake-deg 30 (45 60) --phi-deg 38 "
      "--delta-deg 26.6 --density 1460 --depth 0.10 --cell 0.033 --ahead 4 --expected-n 259 (400 605) --gate-percent "
      "30 --speed 0.05 --from 0.4 --travel 0.5; its pile full grown: --speed 0.3 --from 1.0 --travel 1.5.";
  rig.parameters = kBlade;
  rig.default_soil = clean_sand(35);
  rig.default_soil.tool_friction_angle = 0;
  rig.run = run_blade;
  return rig;
}

Rig wall() {
  Rig rig;
  rig.name = "wall";
  rig.summary = "retaining wall: active and passive earth pressure against Rankine";
  rig.drawing =
      "An upright wall of `height` holds level soil; the soil goes on under its toe. After `wait` it moves `travel` "
      "heights: towards the soil when positive (passive), away when negative (active, --travel -0.03). Plane strain: "
      "the "
      "wall spans a chute of smooth side plates. The force at rest is the mean of the last third of the wait, the "
      "other "
      "the mean over the last fifth of the travel. With --delta-deg the wall is rough over its middle two thirds.";
  rig.parameters = {{"height", 1, "m", "of the wall"},
                    {"travel", 0.2, "heights", "positive: passive, negative: active"},
                    {"speed", 0.1, "m/s", "of the wall"},
                    {"wait", 0.3, "s", "at rest before it moves"},
                    {"rake-deg", 90, "deg", "for the wedge formula"},
                    {"ahead", 3, "heights", "of soil in front"},
                    {"below", 0.5, "heights", "of soil under the toe"}};
  rig.default_soil = clean_sand(35);
  rig.default_soil.tool_friction_angle = 0;
  rig.default_soil.young_modulus = 4e6;  // at 1 MPa a passive wall needs more than a fifth of its height of travel
  rig.run = run_wall;
  return rig;
}

}  // namespace navvy::lab
