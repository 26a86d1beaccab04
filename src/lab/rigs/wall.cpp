// SPDX-License-Identifier: Apache-2.0
// Rig `wall`: a plate as high as the retained soil, moved a little.
//
// Moved away from the soil it measures the active pressure, pushed in the passive one. A wall that
// starts at once sends a wave of rho c_p v through the soil, 2.3 kPa at 0.05 m/s and 4 MPa, against
// an active pressure of 4.3 kPa at the toe. It therefore accelerates slowly, and an active wall is
// slow altogether. The contact's reach cuts its toe short, so an active force needs twenty cells of
// height. A smooth wall is compared with Rankine, a rough one with the bounds of
// theory/earth_pressure.h; planar wedges are listed beside them.
#include <algorithm>
#include <cmath>

#include "lab/rig_shapes.h"
#include "lab/rigs/blade_bed.h"
#include "lab/rigs/chute.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Slopes, walls and cuts]";

/// Default speeds: a passive wall pushes with some ten kPa, an active one with one or two.
// [m/s].
constexpr double kPassiveSpeed = 0.1, kActiveSpeed = 0.01;

/// Returns the speed of the wall, always positive [m/s].
double speed_of(const Setup& setup) {
  const double given = setup["speed"];
  return given > 0 ? given : setup["travel"] > 0 ? kPassiveSpeed : kActiveSpeed;
}

/// Returns the reference of the force per metre of wall. By widths: the wall is rough over `share`
/// of the chute, and soil without tool friction lies beside it.
Reference wall_reference(const Setup& setup, bool passive, double share) {
  BladeCase rough = blade_case(setup, kPi / 2, setup["height"], 1), smooth = rough;
  smooth.delta = smooth.adhesion = 0;
  Reference out = upright_reference(smooth);
  if (!passive) {
    out.expected = out.low = out.high =
        rankine_active_force(rough.phi, rough.cohesion, rough.unit_weight, setup["height"]);
    return out;
  }
  if (!(share > 0)) return out;
  const Reference other = upright_reference(rough);
  const auto mix = [share](double at_sides, double middle) {
    return (1 - share) * at_sides + share * middle;
  };
  out.low = mix(out.low, other.low), out.high = mix(out.high, other.high), out.expected = out.low;
  out.source = other.source, out.rough = true;
  return out;
}

/// Compares the wall's force with theory, with a tolerance where theory applies to this setup.
void read_wall(const Setup& setup, const Vec3& force, double share, Report& report) {
  const scene::Soil& s = setup.soil;
  const double height = setup["height"], weight = s.bank_density * kGravity,
               moved = std::abs(setup["travel"]);
  const bool passive = setup["travel"] > 0, rough = share > 0;
  const Reference theory = wall_reference(setup, passive, share);
  // Smooth walls 10 %; rough ones from 0.95 of the lower bound to 1.05 of the spiral.
  const bool with_tolerance = passive || !rough;
  const bool slow = passive || (speed_of(setup) < 0.0101 && height / setup.cell > 19.99);
  report
      .add(passive ? "passive force" : "active force", force.x(), "N/m", theory.expected,
           with_tolerance ? (theory.rough ? 0.95 : 0.9) * theory.low : kNone,
           with_tolerance ? (theory.rough ? 1.05 : 1.1) * theory.high : kNone,
           theory.source + " " + kSource)
      .holds_for(
          "E of 4 MPa or more, soil that does not soften; pushed in by 0.2 H, or a smooth wall of "
          "20 cells drawn out "
          "by 0.03 H at 0.01 m/s or less",
          s.young_modulus > 3.99e6 && moved > (passive ? 0.1999 : 0.0299) && slow && !softens(s));
  // Ka or Kp as in textbooks.
  if (!rough)
    report.note("coefficient", force.x() / (0.5 * weight * height * height), "", "of 0.5 gamma H2");
  if (rough && passive) {
    // Coulomb's and Reece's wedge, by widths as well; they are not the reference of a rough wall.
    BladeCase c = blade_case(setup, kPi / 2, height, 1), smooth = c;
    smooth.delta = smooth.adhesion = 0;
    const double wedge =
        (1 - share) * reece_wedge(smooth).horizontal + share * reece_wedge(c).horizontal;
    report.add("passive force, against the wedge", force.x(), "N/m", wedge, kNone, kNone,
               "[Reece 1964], planar wedge: an upper bound");
  }
  report.add("vertical over horizontal", force.z() / force.x(), "",
             passive ? share * std::tan(s.tool_friction_angle) : kNone, kNone, kNone,
             "tan delta times the rough share");
}

/// Measures the force per metre at three stages: before it moves, at its minimum (active) or over
/// the last fifth (passive).
Report run_wall(const Setup& setup) {
  const double cell = setup.cell, height = setup["height"], speed = speed_of(setup),
               travel = setup["travel"] * height;
  const bool passive = setup["travel"] > 0;
  double share = 0;
  const double gap = chute_gap(setup, share);
  const double below = whole_cells(height * (1 + setup["below"]), cell);
  // Older than the chute of blades and kept for its recorded numbers: a rough wall is rough over
  // the middle of the chute only, with smooth soil against the plates.
  const ChuteBed bed{6 * cell,
                     cell * std::ceil((std::abs(travel) + setup["ahead"] * height) / cell), below};
  Site site(setup, chute_soils(setup.soil), chute_site(setup, bed, gap));
  ChuteShape shape;
  shape.half = chute_half(cell), shape.gap = gap, shape.height = shape.top = height + 4 * cell;
  shape.back = bed.back + 3 * cell, shape.ahead = bed.ahead + 3 * cell + std::abs(travel),
  shape.bottom = height - below - 2 * cell;
  site.solver().insert(chute_fill(
      site, bed, gap, share > 0,
      [&](const Vec3& p) { return ahead_of_blade(p, height, kPi / 2, cell); }, trench(height)));
  ToolDriver driver(site, blade_chute(shape), make_pose(0, chute_offset(cell), -height));
  // Length of the travel; at most half of it serves the acceleration.
  const double length = std::abs(travel), ramp = std::min(setup["ramp"], 0.5 * length);
  site.expect(setup["wait"] + (length + ramp) / speed + setup["hold"]);
  driver.run(0.7 * setup["wait"]);
  // The last third of the wait, after the ringing of the start.
  const double at_rest = -driver.run(0.3 * setup["wait"]).x() / gap;
  const Vec3 twist(passive ? speed : -speed, 0, 0);
  driver.start(0.8 * length, twist, ramp);
  // The last fifth: the pressure has reached its limit there if the soil is stiff enough.
  const Vec3 last = -driver.advance(0.2 * length, twist) / gap;
  // Stopped at once; the last tenth, long after the ringing.
  const double hold = setup["hold"];
  driver.set_twist(Vec3::Zero());
  if (hold > 0) driver.run(0.9 * hold);
  const double held = hold > 0 ? -driver.run(0.1 * hold).x() / gap : 0;

  const scene::Soil& s = setup.soil;
  const double k0 = s.poisson / (1 - s.poisson);
  Report report;
  report.add("force at rest", at_rest, "N/m",
             0.5 * s.bank_density * kGravity * height * height * k0, kNone, kNone,
             "K0 = nu / (1 - nu), elastic rest");
  read_wall(setup, last, share, report);
  if (hold > 0)
    report.note("force after the stop / force before it", held / last.x(), "",
                "over the last tenth of the hold");
  return finish_blade(site, driver, report);
}

}  // namespace

Rig wall_rig() {
  Rig rig;
  rig.name = "wall";
  rig.summary = "retaining wall: active and passive earth pressure compared with Rankine";
  rig.drawing =
      "An upright wall of `height` retains level soil, which continues under its toe. After "
      "`wait` it moves by `travel` heights: towards the soil if positive (passive), away if "
      "negative (active). Plane strain: the wall spans a chute of smooth side plates; it "
      "accelerates over `ramp`. The force at rest is the mean of the last third of the wait, the "
      "other the mean over the last fifth of the travel. With tool friction (--delta-deg) the "
      "wall is rough over its middle two thirds and compared with the lower bound of Lancellotta "
      "and the log spiral of Caquot and Kerisel; planar wedges are upper bounds and listed for "
      "comparison. With --hold the wall then stands still, and the report gives the remaining "
      "force.";
  rig.examples = {{"Active pressure", "--travel -0.03"},
                  {"Passive pressure at two speeds", "--speed 0.05,0.2"},
                  {"Remaining force after the wall stops", "--hold 0.5,1,2"}};
  rig.parameters = {
      {"height", 1, "m", "of the wall", above(0)},
      {"travel", 0.2, "heights", "positive: passive, negative: active", any()},
      {"speed", 0, "m/s", "of the wall; 0: 0.1 passive, 0.01 active", at_least(0)},
      {"ramp", 0.015, "m", "of travel over which it accelerates; 0: at once", at_least(0)},
      {"wait", 0.3, "s", "at rest before it moves", at_least(0)},
      {"hold", 0, "s", "standing still after the travel; the force at its end is reported",
       at_least(0)},
      {"ahead", 3, "heights", "of soil in front", at_least(0)},
      {"below", 0.5, "heights", "of soil under the toe", at_least(0)}};
  rig.default_cell = 0.05;
  rig.default_soil = clean_sand(35);
  rig.default_soil.tool_friction_angle = 0;
  // At 1 MPa a passive wall needs a travel of more than a fifth of its height.
  rig.default_soil.young_modulus = 4e6;
  rig.headline = {"passive force", "active force", "coefficient", "force at rest",
                  "force after the stop / force before it"};
  rig.experiment = run_wall;
  return rig;
}

}  // namespace navvy::lab
