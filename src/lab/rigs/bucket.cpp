// SPDX-License-Identifier: Apache-2.0
// Rigs `bucket` (filling along a path), `scrape` (flat on level ground), `cycle` (dig and dump at
// one place).
//
// No closed form gives the filling of a bucket. These rigs check that force and load change little
// when the cell is halved, that a bucket dragged flat neither jams nor throws soil, and that
// several digs lose no mass while ground becomes particles and takes them back. The wedge of the
// literature is listed beside the drag for scale only.
#include <algorithm>
#include <cmath>

#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Buckets and carried loads]";

/// Returns the profile of a bucket of unit size: cutting edge, end of the floor, heel, back, rim;
/// the mouth faces forwards and up.
const std::vector<Vec2>& profile() {
  // Like an excavator's: a floor to cut with, a round heel to roll the soil on, a back, an open
  // mouth.
  static const std::vector<Vec2> points = {
      {0, 0}, {-0.6, 0}, {-0.8, 0.15}, {-0.8, 0.5}, {-0.55, 0.7}};
  return points;
}

/// Returns the area of the unit profile, closed by the strike plane from rim to edge (shoelace
/// formula).
double profile_area() {
  double sum = 0;
  for (std::size_t i = 0; i < profile().size(); ++i) {
    const Vec2& a = profile()[i];
    const Vec2& b = profile()[(i + 1) % profile().size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return std::abs(sum);
}

/// A bucket of `width` and struck volume, with its frame at the cutting edge.
struct Bucket {
  double width, size;
  Bucket(double width_in, double volume)
      : width(width_in), size(std::sqrt(volume / (width_in * profile_area()))) {}
  scene::Shell shell() const {
    scene::Shell s;
    s.name = "bucket";
    for (const Vec2& p : profile()) {
      s.vertices.emplace_back(size * p.x(), -width / 2, size * p.y());
      s.vertices.emplace_back(size * p.x(), width / 2, size * p.y());
    }
    // Strips across the width, then a fan from the edge over either side; inside is front.
    for (int i = 0; i + 1 < static_cast<int>(profile().size()); ++i) {
      const int a = 2 * i, b = 2 * i + 2;
      s.triangles.push_back({a, a + 1, b + 1});
      s.triangles.push_back({a, b + 1, b});
    }
    for (int i = 1; i + 1 < static_cast<int>(profile().size()); ++i) {
      // y = -width/2, facing +y.
      s.triangles.push_back({0, 2 * i, 2 * i + 2});
      s.triangles.push_back({1, 2 * i + 3, 2 * i + 1});
    }
    return s;
  }
};

/// Returns the heaped loose volume of a load [m3], on which fill factors are based.
double loose_volume(const scene::Soil& soil, double mass) {
  return mass / soil.bank_density * soil.swell;
}

/// Turns the bucket about its edge by `angle` [rad] (positive: mouth up) while the edge moves by
/// `travel`. Returns the mean force [N].
Vec3 turn(ToolDriver& driver, double angle, const Vec3& travel, double seconds) {
  // Mouth up is a turn about -y.
  driver.set_twist(travel / seconds, Vec3(0, -angle / seconds, 0));
  return driver.run(seconds);
}

/// Path of a filling: edge down at `attack`, level drag, curl, lift. `fill` returns the mean
/// horizontal force of the drag [N].
struct Scoop {
  double depth, drag, speed, attack, curl, lift;
  double fill(ToolDriver& driver) const {
    // The entry is along the floor's own direction: the bucket cuts, its back does not press.
    const double in = depth / std::tan(attack);
    driver.advance(std::hypot(in, depth), speed * Vec3(std::cos(attack), 0, -std::sin(attack)));
    // Floor level, at one or two rad/s.
    turn(driver, attack, Vec3(0.5 * attack * speed, 0, 0), 0.5 * attack);
    const Vec3 force = driver.advance(drag, Vec3(speed, 0, 0));
    // The edge rises as it curls; otherwise the heel would dig in behind it.
    turn(driver, curl, Vec3(0.35 * depth, 0, 1.2 * depth), curl);
    // Slowly enough that the load stays.
    driver.advance(lift, Vec3(0, 0, 0.8));
    return -force.x();
  }
  // For the progress line only.
  double seconds() const {
    return (depth / std::sin(attack) + drag) / speed + 0.5 * attack + curl + lift / 0.8;
  }
};

/// The lift starts from the drag's depth.
Scoop scoop_of(const Setup& setup) {
  return {setup["depth"],
          setup["drag"],
          setup["speed"],
          radians(setup["attack-deg"]),
          radians(setup["curl-deg"]),
          setup["depth"] + setup["lift"]};
}

/// Results of one filling: mean drag [N], load [kg], holding force / weight.
struct Filled {
  double force = 0, payload = 0, held = 0;
};

/// Runs one filling. `write`: the trace goes into the report; the run at half the cell only adds
/// its sums.
Filled run_fill(const Setup& setup, double cell, Report& report, bool write) {
  const Bucket bucket(setup["width"], setup["volume"]);
  const Scoop scoop = scoop_of(setup);
  // More than half a bucket beyond the path on every side, so that the bed's walls have no effect.
  const double reach = scoop.depth / std::tan(scoop.attack) + scoop.drag + 1.0 + 2 * scoop.depth,
               side = bucket.width / 2 + 1.5 * scoop.depth;
  const SiteBox bed{Vec3(-0.5, -whole_cells(side, cell), -whole_cells(scoop.depth + 0.3, cell)),
                    Vec3(whole_cells(reach, cell), whole_cells(side, cell), 0)};
  SiteOptions options;
  options.size = 2 * (reach + 1);
  // Thirty centimetres of particles under the path, then ground.
  options.depth = scoop.depth + 0.3 + 1;
  options.surface = pit(bed);
  options.courant = setup["courant"];
  options.energy = setup.energy;
  Site site(*setup.device, {setup.soil}, cell, options);
  auto soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);
  // The edge starts just above the ground, off the grid's planes in y.
  ToolDriver driver(site, bucket.shell(), make_pose(0, 0.07 * cell, 0.02, 0, scoop.attack, 0));
  Filled out;
  out.force = scoop.fill(driver);
  driver.set_twist(Vec3::Zero());
  // The load settles and loose particles fall before it is weighed.
  driver.run(0.6);
  const Vec3 force = driver.run(0.4);
  out.payload = site.solver().payload(driver.tool(), driver.pose());
  // The payload is counted, the force is measured: two independent readings.
  out.held = force.z() / (-out.payload * kGravity);
  out.held = std::abs(out.held);
  if (write) driver.write(report, setup["speed"] / (2 * cell));
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  site.finish(report);
  return out;
}

/// Runs one filling; with `refine` a second one at half the cell, to which the tolerances apply.
Report run_bucket(const Setup& setup) {
  Report report;
  const Filled coarse = run_fill(setup, setup.cell, report, true);
  const double volume = loose_volume(setup.soil, coarse.payload);
  report.note("mean horizontal force of the drag", coarse.force, "N");
  report.note("load", coarse.payload, "kg");
  report.add("held force over the load's weight", coarse.held, "", 1, 0.98, 1.02,
             std::string("held bucket, grains may fall ") + kSource);
  report.note("loose volume over struck volume", volume / setup["volume"], "");
  // An upright blade of the width and depth of the drag.
  const BladeCase wedge{setup.soil.friction_angle,
                        setup.soil.tool_friction_angle,
                        kPi / 2,
                        setup["depth"],
                        setup["width"],
                        setup.soil.bank_density * kGravity,
                        setup.soil.cohesion,
                        0,
                        0};
  report.add("drag over an upright wedge of the depth",
             coarse.force / reece_wedge(wedge).horizontal, "", kNone, kNone, kNone,
             "[Reece 1964], for scale");
  // The cell is the one length that the soil does not have: a result that changes with it is due to
  // the method.
  if (setup.is("refine", "no")) return report;
  const Filled fine = run_fill(setup, setup.cell / 2, report, false);
  report.add("force over the run at half the cell", coarse.force / fine.force, "", 1, 0.75, 1.25,
             kSource);
  report.add("volume over the run at half the cell", coarse.payload / fine.payload, "", 1, 0.94,
             1.06, kSource);
  return report;
}

/// Returns the largest change of the ground's surface outside the bucket's path [m]. Soil may have
/// been pushed, or have fallen, within one and a half metres beyond the drag's ends and a width
/// beside it.
double change_outside(const heightfield::Ground& ground, double width, double length) {
  double most = 0;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const Vec2 p = ground.origin() + ground.cell() * Vec2(ix + 0.5, iy + 0.5);
      if (std::abs(p.y()) < width && p.x() > -1.5 && p.x() < length + 1.5) continue;
      most = std::max(most, std::abs(ground.height(ix, iy) - ground.start_height(ix, iy)));
    }
  return most;
}

/// Results of the drag of `scrape`.
struct Dragged {
  /// Mean forces; dragging: over the second half [N].
  Vec3 pressing = Vec3::Zero(), dragging = Vec3::Zero();
  /// In the bucket at its end [kg].
  double load = 0;
};

/// Each drag has its own ground, which becomes particles where the bucket comes; there are none at
/// the start.
SiteOptions scrape_site(const Setup& setup, bool crowding) {
  SiteOptions options;
  options.size = 2 * (setup["drag"] + 4);
  options.depth = 2;
  options.exchange = true;
  options.crowding = crowding;
  return options;
}

Dragged drag_flat(const Setup& setup, const Site& site, ToolDriver& driver) {
  const double press = setup["press"], drag = setup["drag"];
  const Vec3 ahead(setup["speed"], 0, 0);
  Dragged out;
  // A fifth of a second, hard: a jam would show as an unbounded force.
  out.pressing = driver.advance(press + 0.01, Vec3(0, 0, -(press + 0.01) / 0.2));
  driver.advance(0.5 * drag, ahead);
  // The first half fills the bucket, the second is read.
  out.dragging = driver.advance(0.5 * drag, ahead);
  out.load = site.solver().payload(driver.tool(), driver.pose());
  return out;
}

/// Runs flat contact over the whole floor, the case in which a grid contact is most likely to jam.
/// Compared with the same drag without crowding: separating particles must not carry soil that
/// slides over them.
Report run_scrape(const Setup& setup) {
  const Bucket bucket(setup["width"], setup["volume"]);
  const Pose start = make_pose(0, 0.07 * setup.cell, 0.015 + 0.01);
  const double drag = setup["drag"], speed = setup["speed"];
  Setup silent = setup;
  silent.progress = nullptr;
  Site plain(silent, scrape_site(setup, false));
  ToolDriver plain_driver(plain, bucket.shell(), start);
  const Dragged without = drag_flat(setup, plain, plain_driver);

  Site site(setup, scrape_site(setup, true));
  ToolDriver driver(site, bucket.shell(), start);
  site.expect(0.2 + drag / speed + 4);
  const Dragged with = drag_flat(setup, site, driver);
  driver.advance(0.8, Vec3(0, 0, 0.8));
  // Compressed soil that springs back would throw particles as the bucket leaves.
  const double fastest = site.solver().stats().max_speed;
  driver.set_twist(Vec3::Zero());
  // Time for soil to come to rest and return to the ground, so that the surface is complete again.
  driver.run(3);
  Report report;
  report.add("drag, second half", -with.dragging.x(), "N", -without.dragging.x(),
             -0.75 * without.dragging.x(), -1.25 * without.dragging.x(),
             std::string("the same with crowding off, 25 % ") + kSource);
  report.note("vertical force while pressing, mean", with.pressing.z(), "N");
  report.add("vertical force, second half of the drag", std::abs(with.dragging.z()), "N", kNone,
             kNone, 1.2 * with.load * kGravity,
             std::string("the weight of the load and 20 %, either way ") + kSource);
  // Three times the bucket's own speed: particles may roll, not be thrown.
  report.add("fastest soil when the bucket lifts off", fastest, "m/s", speed, kNone, 3 * speed,
             std::string("no energy gain ") + kSource);
  report.add("ground outside the path", 1000 * change_outside(site.ground(), bucket.width, drag),
             "mm", 0, kNone, 1000 * setup.cell, std::string("one cell ") + kSource);
  report.note("soil in the bucket at the end of the drag", with.load, "kg");
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  report.add("ledger", static_cast<double>(site.solver().ledger().error()), "quanta", 0, 0, 0,
             "closed [docs/exchange.md, ledger]");
  driver.write(report, speed / (2 * setup.cell));
  site.finish(report);
  return report;
}

/// Digs, carries and dumps repeatedly at one place, on ground that exchanges soil with the
/// particles.
Report run_cycle(const Setup& setup) {
  const Bucket bucket(setup["width"], setup["volume"]);
  const Scoop scoop = scoop_of(setup);
  SiteOptions options;
  options.size = 20;
  options.depth = 4;
  options.exchange = true;
  Site site(setup, options);
  const int count = setup.whole("cycles");
  const double away = setup["dump"];
  const Pose start = make_pose(0, 0.07 * setup.cell, 0.02, 0, scoop.attack, 0);
  ToolDriver driver(site, bucket.shell(), start);
  // Lifting, dumping and waiting take five seconds per cycle.
  site.expect(count * (scoop.seconds() + 2 * away / 3 + 5));
  Series volumes{"loose volume over struck volume", "", {}}, forces{"mean drag", "N", {}};
  double ledger = 0, sum = 0;
  for (int i = 0; i < count; ++i) {
    // Each dig begins where the last one left the floor, deeper by the step.
    const Pose above_hole =
        make_pose(0, 0.07 * setup.cell, 0.02 - i * setup["step-down"], 0, scoop.attack, 0);
    // Placed there instead of moved: the way back would cost time and touch nothing.
    site.tool(driver.tool()).motion.X_WT = above_hole;
    forces.values.push_back(scoop.fill(driver));
    driver.advance(1.0 + i * setup["step-down"], Vec3(0, 0, 1));
    driver.set_twist(Vec3::Zero());
    driver.run(0.3);
    const double mass = site.solver().payload(driver.tool(), driver.pose());
    volumes.values.push_back(loose_volume(setup.soil, mass) / setup["volume"]);
    sum += volumes.values.back();
    driver.advance(away, Vec3(0, 3, 0));
    // Dumped, with time for the last particles to fall.
    turn(driver, -radians(130), Vec3::Zero(), 1.3);
    driver.set_twist(Vec3::Zero());
    driver.run(1.2);
    turn(driver, radians(130), Vec3(0, 0, 0.8), 1.0);
    driver.advance(away, Vec3(0, -3, 0));
    // Summed, not read at the end: errors of two cycles must not cancel.
    ledger += std::abs(static_cast<double>(site.solver().ledger().error()));
  }
  driver.set_twist(Vec3::Zero());
  driver.run(2);
  Report report;
  report.add("loose volume over struck volume, mean", sum / count, "", kNone, kNone, kNone,
             std::string("moist loam 1.00 .. 1.10 with an operator's path ") + kSource);
  report.note("first cycle", volumes.values.front(), "");
  report.note("last cycle", volumes.values.back(), "");
  report.add("ledger, summed over cycles", ledger, "quanta", 0, 0, 0,
             "exact: mass is counted in whole quanta [docs/exchange.md, ledger]");
  report.note("activated columns", static_cast<double>(site.solver().stats().activations), "");
  report.note("deposits", static_cast<double>(site.solver().stats().deposits), "");
  report.note("particles at the end", site.solver().stats().particles, "");
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  report.series = {volumes, forces};
  site.finish(report);
  return report;
}

/// Returns the parameters of all rigs that fill a bucket on the path of `Scoop`.
std::vector<Parameter> scoop_parameters() {
  return {{"width", 0.8, "m", "of the bucket", above(0)},
          {"volume", 0.3, "m3", "struck, of the bucket", above(0)},
          {"depth", 0.25, "m", "of the cutting edge in the drag", above(0)},
          {"drag", 0.8, "m", "level", above(0)},
          {"speed", 0.8, "m/s", "of the cutting edge", above(0)},
          {"attack-deg", 30, "deg", "of the floor as the edge enters", between(10, 80)},
          {"curl-deg", 50, "deg", "by which it turns up after the drag", between(1, 120)},
          {"lift", 0.4, "m", "after the curl, in addition to `depth`", above(0)}};
}

}  // namespace

Rig bucket_rig() {
  Rig rig;
  rig.name = "bucket";
  rig.summary = "bucket filled along a path: force and load, compared with half the cell";
  rig.drawing =
      "A bucket (flat floor, heel, back, two sides, 30 mm plates) enters a bed with its floor at "
      "`attack-deg`, levels out at `depth`, is dragged by `drag` at `speed`, curls by `curl-deg`, "
      "rises by `depth` and `lift`, and holds. `refine` yes repeats it at half the cell and "
      "compares the load and the mean force of the drag.";
  rig.parameters = scoop_parameters();
  rig.parameters.push_back(yes_no("refine", false, "also at half the cell", "one run"));
  rig.headline = {"mean horizontal force of the drag", "load", "held force over the load's weight",
                  "drag over an upright wedge of the depth"};
  rig.examples = {{"Two cells and two steps in one table, with a plot",
                   "--cell 0.1,0.05 --courant 0.5,0.25 --plot bucket.svg"}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_bucket;
  return rig;
}

Rig scrape_rig() {
  Rig rig;
  rig.name = "scrape";
  rig.summary = "bucket pressed flat on level ground and dragged: no jam, no gain of energy";
  rig.drawing =
      "The bucket's floor is pressed `press` into level resting ground in 0.2 s, dragged by "
      "`drag` at `speed`, and lifted. The ground becomes particles and takes soil back by itself. "
      "The second half of the drag is compared with the same without crowding, its vertical force "
      "with the weight of the load.";
  rig.parameters = {{"width", 0.8, "m", "of the bucket", above(0)},
                    {"volume", 0.3, "m3", "struck, of the bucket", above(0)},
                    {"press", 0.05, "m", "into the ground", at_least(0)},
                    {"drag", 1, "m", "level", above(0)},
                    {"speed", 1, "m/s", "of the drag", above(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_scrape;
  return rig;
}

Rig cycle_rig() {
  Rig rig;
  rig.name = "cycle";
  rig.summary = "dig and dump several times at one place: volume per pass, ledger";
  rig.drawing =
      "The bucket follows the path of rig `bucket`, `cycles` times, each `step-down` deeper, on "
      "ground that becomes particles and takes soil back by itself. Every load is carried `dump` "
      "to the side and dumped by a turn of 130 degrees.";
  rig.parameters = scoop_parameters();
  rig.parameters.push_back({"cycles", 3, "", "in all", count_from(1)});
  rig.parameters.push_back({"step-down", 0.15, "m", "per cycle", above(0)});
  rig.parameters.push_back({"dump", 2.5, "m", "to the side", above(0)});
  rig.default_soil = clean_sand(35);
  rig.experiment = run_cycle;
  return rig;
}

}  // namespace navvy::lab
