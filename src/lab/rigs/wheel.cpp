// SPDX-License-Identifier: Apache-2.0
// Rig `wheel`: one wheel rolls, spins or is dragged over a bed of particles under a load, at a
// prescribed slip; or the wheel law alone, without particles (`law`).
//
// This is the single-wheel test of terramechanics: slip is prescribed, the wheel sinks freely, and
// pull, torque and sinkage are measured. The formulas beside the results integrate a measured plate
// curve over the rim. The particles do not use that curve, so a difference between both is no error
// of either. For any soil, the wheel must carry its load, no particle may pass the drum, more slip
// must pull more, and power must go into the soil and never come out.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/tool_driver.h"
#include "scene/soil_values.h"
#include "terramechanics/rigid_wheel.h"

namespace navvy::lab {
namespace {

using terramechanics::rigid_wheel;
using terramechanics::rim_speed;
using terramechanics::WheelCase;
using terramechanics::WheelForce;

constexpr const char* kLawSource =
    "[Bekker 1969] [Janosi 1961] [Lyasko 2010] over the arc, the soil's own parameters "
    "[docs/validation.md, Wheels]";
constexpr const char* kNotCarried = "none: by Bekker's law the soil does not carry this load";
// Seconds over which the load increases, at standstill; the start takes half as long.
constexpr double kLoading = 0.3;
// Sinking speed at which the carriage's damper carries a tenth of the load [m/s].
constexpr double kDashpot = 0.05;

WheelCase wheel_of(const Setup& setup) {
  WheelCase wheel{setup["radius"], setup["width"], setup["load-n"], setup["slip"]};
  wheel.slip_angle = radians(setup["slip-angle-deg"]);
  wheel.grouser = setup["grouser"];
  wheel.slip_sinkage = setup["slip-sinkage"];
  return wheel;
}

/// Returns dry sand of a single-wheel test bed [docs/validation.md, Wheels]: its angle of 29
/// degrees is one of repose, its plate curve is 1734 kPa (z / m)^1.34; 20 degrees of friction on
/// the rim are an estimate.
scene::Soil wheel_bed_sand() {
  scene::Soil soil = clean_sand(0);
  set_friction(soil, scene::FrictionTest::kRepose, radians(29));
  scene::follow_friction_test(soil);
  soil.bank_density = 13000 / kGravity;
  soil.tool_friction_angle = radians(20);
  // For the plate curve: used by the formula beside the rig, not by the particles.
  soil.bekker_kc = 0, soil.bekker_kphi = 1734000, soil.bekker_n = 1.34;
  soil.janosi_k = 0.021;
  return soil;
}

/// Returns the soil as the wheel law reads it: Janosi's friction angle is that of a shear plate, a
/// direct shear test [docs/soil.md, friction angles].
scene::Soil law_soil(const Setup& setup) {
  scene::Soil soil = setup.soil;
  soil.friction_angle = scene::angle_in_test(scene::FrictionTest::kDirectShear, soil.friction_angle,
                                             soil.dilatancy_angle);
  return soil;
}

/// Checks relations between parameters, and to the cell; their own ranges are checked already.
void check_wheel(const Setup& setup) {
  std::vector<Fault> faults;
  const auto refuse = [&faults](const char* name, double value, const char* rule,
                                const char* remedy) {
    faults.push_back(Fault{Fault::Severity::kError, "", 0, std::string("lab wheel --") + name,
                           short_text(value), rule, remedy});
  };
  const double radius = setup["radius"];
  // Without cells there is no travel.
  if (setup.is("law", "yes")) return;
  if (setup["slip-angle-deg"] != 0)
    refuse("slip-angle-deg", setup["slip-angle-deg"], "0 on particles", "--law yes");
  if (setup["grouser"] > 0)
    refuse("grouser", setup["grouser"], "0 on particles: their drum is smooth", "--law yes");
  if (radius < 4 * setup.cell)
    refuse("radius", radius, "at least 4 cells", "a finer --cell, or a larger wheel");
  if (setup["width"] < 2 * setup.cell)
    refuse("width", setup["width"], "at least 2 cells", "a finer --cell, or a wider wheel");
  if (setup["from"] >= setup["travel"])
    refuse("from", setup["from"], "less than the travel", "half the travel is usual");
  if (!faults.empty()) throw InputError(faults);
}

/// Reports the wheel law by itself.
Report law_alone(const Setup& setup) {
  const WheelCase wheel = wheel_of(setup);
  const WheelForce law = rigid_wheel(wheel, law_soil(setup));
  const auto value = [&law](double number) { return law.carried ? number : kNone; };
  const std::string source = law.carried ? kLawSource : kNotCarried;
  Report report;
  report.note("drawbar pull", value(law.drawbar), "N", source);
  report.note("sinkage", value(1000 * law.sinkage), "mm", source);
  report.note("torque", value(law.torque), "N m", source);
  report.note("side force", value(law.side), "N",
              "against the motion to the side, side wall included");
  report.note("side force on the side wall", value(law.side_wall), "N",
              "passive resistance [Bekker 1969] [docs/machines.md, ruts]");
  report.note("bulldozing resistance", value(law.bulldozing), "N",
              "[Bekker 1969], counted in the pull");
  report.note("drawbar pull over the load", value(law.drawbar / wheel.load), "");
  const double in = law.torque * rim_speed(setup["speed"], wheel.slip) / wheel.radius;
  report.note("tractive efficiency", in > 0 ? value(law.drawbar * setup["speed"] / in) : kNone, "",
              "pull x speed over torque x turning");
  return report;
}

/// Returns a bed so long and wide that its ends have no effect; the wheel starts over x = 0.
SiteBox bed_of(const Setup& setup) {
  const double cell = setup.cell, r = setup["radius"];
  // A wheel pushes soil aside by less than its radius.
  const double side = whole_cells(setup["width"] / 2 + setup["beside"] * r, cell);
  return {Vec3(-whole_cells(2 * r, cell), -side, -whole_cells(setup["below"] * r, cell)),
          Vec3(whole_cells(setup["travel"] + 2.5 * r, cell), side, 0)};
}

/// Returns a site with a pit for the bed.
SiteOptions site_options(const Setup& setup, const SiteBox& bed) {
  SiteOptions options;
  options.size = 2 * (std::max(bed.high.x(), bed.high.y()) + 4 * setup.cell);
  options.depth = -bed.low.z() + 8 * setup.cell;
  options.surface = pit(bed);
  return options;
}

/// Returns the wheel's shell. Contact reaches past a shell by up to a cell: one of the wheel's own
/// size would stand on air. Its faces are therefore inside radius and width by the offset.
scene::Shell drum_of(const Setup& setup, const WheelCase& wheel) {
  const double half = 0.25 * setup.cell, inset = half + setup["offset"] * setup.cell;
  scene::Shell shell = drum(wheel.radius - inset, wheel.width - 2 * inset);
  shell.half_thickness = half;
  return shell;
}

/// Loads the wheel slowly, then moves it at its slip over the travel. Records the height of the
/// axle over time in `height`.
class Carriage {
 public:
  // The wheel's mass is its load over g, so that it sinks with the inertia of that load.
  Carriage(const Setup& setup, ToolDriver& driver)
      : setup_(setup), driver_(driver), wheel_(wheel_of(setup)) {
    Tool& tool = driver.site().tool(driver.tool());
    tool.mass = wheel_.load / kGravity;
    tool.only_sinks = true;
  }

  void run() {
    // A load applied at once would dig a hole that the wheel must then climb out of.
    load_up(kLoading);
    const double speed = setup_["speed"];
    run_for(kLoading / 2, [&](double share) { roll(share * speed); });
    run_for(setup_["travel"] / speed, [&](double) { roll(speed); });
  }

  const std::vector<double>& height() const { return height_; }
  double touched() const { return touched_; }

 private:
  Tool& tool() { return driver_.site().tool(driver_.tool()); }

  /// Sinking is free: only the twist along the path and about the axle is set.
  void roll(double speed) {
    const double rim = rim_speed(speed, wheel_.slip);
    driver_.set_twist(Vec3(speed, 0, tool().motion.v_WT.z()), Vec3(0, rim / wheel_.radius, 0));
  }

  /// The carriage carries less and less of the load, linearly.
  void load_up(double seconds) {
    run_for(seconds, [&](double share) { bearing_ = 1 - share; });
    bearing_ = 0;
  }

  template <class Each>
  void run_for(double seconds, const Each& each) {
    // One step for the whole run, and so for the later speed: the wheel stands still when it is
    // computed.
    const double dt =
        driver_.site().step_limit(rim_speed(setup_["speed"], std::max(0.0, wheel_.slip)) * 1.5);
    const int steps = std::max(1, static_cast<int>(std::ceil(seconds / dt)));
    for (int i = 0; i < steps; ++i) {
      each((i + 1.0) / steps);
      const double damper = -0.1 * wheel_.load * tool().motion.v_WT.z() / kDashpot;
      // The carriage carries its share of the load; its damper absorbs the bounce.
      tool().force_W = Vec3(0, 0, bearing_ * wheel_.load + damper);
      driver_.step(seconds / steps);
      height_.push_back(driver_.pose().translation().z());
      // The first force that is more than noise.
      if (std::isnan(touched_) && driver_.trace().force.back().z() > 0.02 * wheel_.load)
        touched_ = height_.back();
    }
  }

  const Setup& setup_;
  ToolDriver& driver_;
  WheelCase wheel_;
  /// Share of the load that the carriage carries.
  double bearing_ = 1;
  double touched_ = kNone;
  std::vector<double> height_;
};

/// Means over the steps from a time on.
struct Steady {
  /// Force of the soil on the wheel, moment about the axle [N], [N m].
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  /// Of the axle over the level ground [m].
  double height = 0;
};

Steady steady_part(const Trace& trace, const std::vector<double>& height, double from_time) {
  Steady out;
  int count = 0;
  for (std::size_t i = 0; i < trace.time.size(); ++i) {
    // By time and not by travel: the travel of the driver includes the sinking.
    if (trace.time[i] < from_time) continue;
    out.force += trace.force[i];
    out.moment += trace.moment[i];
    out.height += height[i];
    ++count;
  }
  out.force /= count, out.moment /= count, out.height /= count;
  return out;
}

/// Fills the bed, loads the wheel, rolls, and averages the last part of the path.
Report run(const Setup& setup) {
  check_wheel(setup);
  if (setup.is("law", "yes")) return law_alone(setup);
  const WheelCase wheel = wheel_of(setup);
  const SiteBox bed = bed_of(setup);
  Site site(setup, site_options(setup, bed));
  auto soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);

  ToolDriver driver(
      site, drum_of(setup, wheel),
      make_pose(0, 0.07 * setup.cell, wheel.radius + (1.5 - setup["offset"]) * setup.cell));
  Carriage carriage(setup, driver);
  const double travel_time = setup["travel"] / setup["speed"], start = 1.5 * kLoading;
  site.expect(start + travel_time);
  carriage.run();

  // The bed's first half absorbs the start; a wheel needs about a diameter of path to reach its
  // sinkage.
  const Trace& trace = driver.trace();
  const Steady mean =
      steady_part(trace, carriage.height(), start + travel_time * setup["from"] / setup["travel"]);
  // A soil too soft for the law has no expected values; the report says so.
  const WheelForce law = rigid_wheel(wheel, law_soil(setup));
  const std::string source = law.carried ? kLawSource : kNotCarried;
  const auto expected = [&law](double value) { return law.carried ? value : kNone; };
  Report report;
  report.add("drawbar pull", mean.force.x(), "N", expected(law.drawbar), kNone, kNone, source);
  report.add("sinkage", 1000 * (wheel.radius - mean.height), "mm", expected(1000 * law.sinkage),
             kNone, kNone, source);
  report.add("torque", -mean.moment.y(), "N m", expected(law.torque), kNone, kNone, source);
  report.add("vertical force over the load", mean.force.z() / wheel.load, "", 1, 0.95, 1.05,
             "statics [docs/validation.md, Wheels]");
  report.note(
      "torque over radius x load", -mean.moment.y() / (wheel.radius * wheel.load), "",
      "tan delta = " + std::to_string(std::tan(setup.soil.tool_friction_angle)).substr(0, 5) +
          " carries at most about this");
  // Soil dissipates energy: a negative value means that the contact creates some.
  report.note("power in: torque x turning less pull x speed",
              -mean.moment.y() * rim_speed(setup["speed"], wheel.slip) / wheel.radius -
                  mean.force.x() * setup["speed"],
              "W", "lost in soil and slip; above 0");
  report.note("first touched above the ground by", 1000 * (carriage.touched() - wheel.radius), "mm",
              "at a fiftieth of the load; contact reaches a cell");
  report.add("particles through the wheel",
             static_cast<double>(site.solver().stats().shell_crossings), "", 0, kNone, 0,
             "none may pass; summed over steps [docs/validation.md, Wheels]");
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  driver.write(report, 20);
  // Low-passed like the forces: facets of 7.5 degrees ring.
  std::vector<double> torque;
  for (const Vec3& moment : trace.moment) torque.push_back(-moment.y());
  report.series.push_back({"torque", "N m", low_pass(trace.time, torque, 20)});
  report.series.push_back({"axle_height", "m", carriage.height()});
  site.finish(report);
  return report;
}

}  // namespace

Rig wheel_rig() {
  Rig rig;
  rig.name = "wheel";
  rig.summary = "one wheel at a prescribed slip: drawbar pull, sinkage, torque";
  rig.drawing =
      "A smooth closed wheel of `radius` and `width` is lowered on level soil until the soil "
      "carries `load-n`. It then moves ahead at `speed` and turns at a prescribed slip: 0 rolls, "
      "0.2 turns a quarter faster than it moves, -0.2 brakes, -1 is locked. It is free to sink; "
      "its path and rotation are driven, as in a single-wheel test bed, and a damper carries a "
      "tenth of the load at a sinking speed of 0.05 m/s. Pull, sinkage and torque are means from "
      "`from` to `travel`; sinkage is that of the rim's lowest point below the level ground. For "
      "comparison the report lists the laws of Bekker and Janosi over the arc with the soil's own "
      "parameters, which the particles do not use; those of the default soil were measured on its "
      "sand. Contact begins up to a cell before the shell; `offset` compensates for it. With "
      "`law` only those formulas are evaluated, without simulated time, also at a slip angle and "
      "with grousers.";
  rig.parameters = {
      {"radius", 0.0625, "m", "of the wheel, 4 cells or more", above(0)},
      {"width", 0.06, "m", "of the wheel, 2 cells or more", above(0)},
      {"load-n", 24.6, "N", "on the axle, the wheel's own weight included", above(0)},
      {"slip", 0.2, "", "prescribed: 0 rolls, 0.2 pulls, -0.2 brakes, -1 is locked",
       between(-1, 0.95)},
      {"speed", 0.2, "m/s", "of the axle", above(0)},
      {"travel", 0.25, "m", "of the axle", above(0)},
      {"from", 0.12, "m", "where the means begin", above(0)},
      {"offset", 0.5, "cells",
       "by which the shell is smaller than the wheel on every side: contact reaches farther",
       at_least(0)},
      {"beside", 1.6, "radii", "of soil on either side", at_least(0)},
      {"below", 2.2, "radii", "of soil", at_least(0)},
      {"slip-angle-deg", 0, "deg", "between path and wheel, for the law only", between(0, 80)},
      {"grouser", 0, "m", "height of bars on the rim, for the law only; 0 is smooth", at_least(0)},
      {"slip-sinkage", 1, "",
       "coefficient of the law's sinkage by slip: 1 as in [Lyasko 2010], 0 none", between(0, 3)},
      yes_no("law", false, "the law alone, without particles",
             "particles, with the law for comparison")};
  rig.examples = {{"A wheel on a soil whose plate curve is known",
                   "--slip 0.2 --set bekker_kphi_n_per_m_n2=1734000 --set bekker_n=1.34 --set "
                   "janosi_k_m=0.021"}};
  rig.examples.push_back({"Pull against slip by the law, a wheel with grousers at a slip angle",
                          "--law yes --slip 0,0.1,0.2,0.4,0.6 --grouser 0.005 --slip-angle-deg 5"});
  rig.default_soil = wheel_bed_sand();
  rig.default_cell = 0.01;
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
