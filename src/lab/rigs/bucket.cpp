// SPDX-License-Identifier: Apache-2.0
// Rigs `bucket` (fill along a path), `scrape` (flat on level ground), `cycle` (dig and dump at one
// place).
//
// No closed form fills a bucket. What can be asked is that force and load change little when the
// cell is halved, that a bucket dragged flat neither jams nor throws, and that over several digs
// not a gram is lost while ground wakes and takes soil back. The wedge of the literature stands
// beside the drag for scale only.
#include <algorithm>
#include <cmath>

#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Buckets and carried loads]";

/// Profile of a bucket of unit size: lip, end of the floor, heel, back, rim; the mouth looks ahead
/// and up.
const std::vector<Vec2>& profile() {
  // Like an excavator's: a floor to cut with, a round heel to roll the soil on, a back, an open
  // mouth.
  static const std::vector<Vec2> points = {
      {0, 0}, {-0.6, 0}, {-0.8, 0.15}, {-0.8, 0.5}, {-0.55, 0.7}};
  return points;
}

/// Of the unit profile, rim to lip closed by the strike plane: the shoelace formula.
double profile_area() {
  double sum = 0;
  for (std::size_t i = 0; i < profile().size(); ++i) {
    const Vec2& a = profile()[i];
    const Vec2& b = profile()[(i + 1) % profile().size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return std::abs(sum);
}

/// A bucket of `width` and struck volume, with its frame at the lip.
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
    // Strips across the width, then a fan from the lip over either side; inside is front.
    for (int i = 0; i + 1 < static_cast<int>(profile().size()); ++i) {
      const int a = 2 * i, b = 2 * i + 2;
      s.triangles.push_back({a, a + 1, b + 1});
      s.triangles.push_back({a, b + 1, b});
    }
    for (int i = 1; i + 1 < static_cast<int>(profile().size()); ++i) {
      s.triangles.push_back({0, 2 * i, 2 * i + 2});  // y = -width/2, looks along +y
      s.triangles.push_back({1, 2 * i + 3, 2 * i + 1});
    }
    return s;
  }
};

/// What a load would measure when heaped loose [m3]: fill factors are quoted so.
double loose_volume(const scene::Soil& soil, double mass) {
  return mass / soil.bank_density * soil.swell;
}

/// Turns the bucket about its lip by `angle` [rad] (positive: mouth up) while the lip moves by
/// `travel`.
Vec3 turn(ToolDriver& driver, double angle, const Vec3& travel, double seconds) {
  // Mouth up is a turn about -y.
  driver.set_twist(travel / seconds, Vec3(0, -angle / seconds, 0));
  return driver.run(seconds);
}

/// Lip down at `attack`, level drag, curl, lift: `fill` returns the mean horizontal force of the
/// drag [N].
struct Scoop {
  double depth, drag, speed, attack, curl, lift;
  double fill(ToolDriver& driver) const {
    // The way in is along the floor's own direction: the bucket cuts, its back does not press.
    const double in = depth / std::tan(attack);
    driver.advance(std::hypot(in, depth), speed * Vec3(std::cos(attack), 0, -std::sin(attack)));
    // Floor level, one rad/s or two
    turn(driver, attack, Vec3(0.5 * attack * speed, 0, 0), 0.5 * attack);
    const Vec3 force = driver.advance(drag, Vec3(speed, 0, 0));
    // The lip rises as it curls, or the heel would dig in behind it.
    turn(driver, curl, Vec3(0.35 * depth, 0, 1.2 * depth), curl);
    // Slowly enough that what lies in it stays.
    driver.advance(lift, Vec3(0, 0, 0.8));
    return -force.x();
  }
  // For the progress line alone.
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

/// What one filling gave: mean drag [N], load [kg], force that holds it over its weight.
struct Filled {
  double force = 0, payload = 0, held = 0;
};

/// `write`: the trace goes into the report; of the run at half the cell only the sums do.
Filled run_fill(const Setup& setup, double cell, Report& report, bool write) {
  const Bucket bucket(setup["width"], setup["volume"]);
  const Scoop scoop = scoop_of(setup);
  // Half a bucket and more beyond the path on every side, so that the bed's walls are not felt.
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
  // The lip starts just over the ground, off the grid's planes in y.
  ToolDriver driver(site, bucket.shell(), make_pose(0, 0.07 * cell, 0.02, 0, scoop.attack, 0));
  Filled out;
  out.force = scoop.fill(driver);
  driver.set_twist(Vec3::Zero());
  // The load settles and loose grains fall before it is weighed.
  driver.run(0.6);
  const Vec3 force = driver.run(0.4);
  out.payload = site.solver().payload(driver.tool(), driver.pose());
  // The payload is counted, the force is felt: both by other ways.
  out.held = force.z() / (-out.payload * kGravity);
  out.held = std::abs(out.held);
  if (write) driver.write(report, setup["speed"] / (2 * cell));
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  site.finish(report);
  return out;
}

/// One filling; with `refine` a second one at half the cell, which is what the gates compare.
Report run_bucket(const Setup& setup) {
  Report report;
  const Filled coarse = run_fill(setup, setup.cell, report, true);
  const double volume = loose_volume(setup.soil, coarse.payload);
  report.note("mean horizontal force of the drag", coarse.force, "N");
  report.note("load", coarse.payload, "kg");
  report.add("held force over the load's weight", coarse.held, "", 1, 0.98, 1.02,
             std::string("held bucket, grains may fall ") + kSource);
  report.note("loose volume over struck volume", volume / setup["volume"], "");
  // An upright blade as wide and as deep as the drag.
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
  // The cell is the one length the soil does not have: a result that changes with it is the
  // method's.
  if (setup.is("refine", "no")) return report;
  const Filled fine = run_fill(setup, setup.cell / 2, report, false);
  report.add("force over the run at half the cell", coarse.force / fine.force, "", 1, 0.75, 1.25,
             kSource);
  report.add("volume over the run at half the cell", coarse.payload / fine.payload, "", 1, 0.94,
             1.06, kSource);
  return report;
}

/// Highest change of the ground's surface outside the bucket's path [m]. One and a half metres
/// beyond the drag's ends and a width beside it, soil may have been pushed or fallen.
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

/// What the drag of `scrape` told.
struct Dragged {
  /// Mean forces; dragging: over the second half [N].
  Vec3 pressing = Vec3::Zero(), dragging = Vec3::Zero();
  double load = 0;  ///< in the bucket at its end [kg]
};

/// Ground of its own for every drag: it wakes where the bucket comes, without particles at the
/// start.
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
  // A fifth of a second, hard: a jam would show as a force without bound.
  out.pressing = driver.advance(press + 0.01, Vec3(0, 0, -(press + 0.01) / 0.2));
  driver.advance(0.5 * drag, ahead);
  // The first half fills the bucket, the second is read.
  out.dragging = driver.advance(0.5 * drag, ahead);
  out.load = site.solver().payload(driver.tool(), driver.pose());
  return out;
}

/// Flat contact over the whole floor, the case in which a grid contact is most likely to jam. Held
/// against the same drag without crowding: moving particles apart must not carry what slides over
/// them.
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
  // Compressed soil that springs back would throw grains as the bucket leaves.
  const double fastest = site.solver().stats().max_speed;
  driver.set_twist(Vec3::Zero());
  // Time to come to rest and go back into the ground, so that its surface is whole again.
  driver.run(3);
  Report report;
  report.add("drag, second half", -with.dragging.x(), "N", -without.dragging.x(),
             -0.75 * without.dragging.x(), -1.25 * without.dragging.x(),
             std::string("the same with crowding off, 25 % ") + kSource);
  report.note("vertical force while pressing, mean", with.pressing.z(), "N");
  report.add("vertical force, second half of the drag", std::abs(with.dragging.z()), "N", kNone,
             kNone, 1.2 * with.load * kGravity,
             std::string("the weight of the load and 20 %, either way ") + kSource);
  // Three times the bucket's own speed: grains may roll, not be shot.
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

/// Digs, carries and tips again and again at one place, on ground that exchanges soil with the
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
  // Five seconds a cycle go for lifting, tipping and waiting.
  site.expect(count * (scoop.seconds() + 2 * away / 3 + 5));
  Series volumes{"loose volume over struck volume", "", {}}, forces{"mean drag", "N", {}};
  double ledger = 0, sum = 0;
  for (int i = 0; i < count; ++i) {
    // Each dig begins where the last one left the floor, deeper by the step.
    const Pose home =
        make_pose(0, 0.07 * setup.cell, 0.02 - i * setup["step-down"], 0, scoop.attack, 0);
    // Put back rather than moved: the way home would cost time and touch nothing.
    site.tool(driver.tool()).motion.X_WT = home;  // in the air over the hole
    forces.values.push_back(scoop.fill(driver));
    driver.advance(1.0 + i * setup["step-down"], Vec3(0, 0, 1));
    driver.set_twist(Vec3::Zero());
    driver.run(0.3);
    const double mass = site.solver().payload(driver.tool(), driver.pose());
    volumes.values.push_back(loose_volume(setup.soil, mass) / setup["volume"]);
    sum += volumes.values.back();
    driver.advance(away, Vec3(0, 3, 0));
    // Tipped, and given time for the last grains to fall.
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
  report.note("wakes", static_cast<double>(site.solver().stats().wakes), "");
  report.note("deposits", static_cast<double>(site.solver().stats().deposits), "");
  report.note("particles at the end", site.solver().stats().particles, "");
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  report.series = {volumes, forces};
  site.finish(report);
  return report;
}

/// Shared by the rigs that fill a bucket on the path of `Scoop`.
std::vector<Parameter> scoop_parameters() {
  return {{"width", 0.8, "m", "of the bucket", above(0)},
          {"volume", 0.3, "m3", "struck, of the bucket", above(0)},
          {"depth", 0.25, "m", "of the lip in the drag", above(0)},
          {"drag", 0.8, "m", "level", above(0)},
          {"speed", 0.8, "m/s", "of the lip", above(0)},
          {"attack-deg", 30, "deg", "of the floor as the lip goes in", between(10, 80)},
          {"curl-deg", 50, "deg", "by which it turns up behind the drag", between(1, 120)},
          {"lift", 0.4, "m", "behind the curl, over and above `depth`", above(0)}};
}

}  // namespace

Rig bucket_rig() {
  Rig rig;
  rig.name = "bucket";
  rig.summary = "bucket filled along a path: force and load, against half the cell";
  rig.drawing =
      "A bucket (flat floor, heel, back, two sides, 30 mm plates) goes into a bed with its floor "
      "at `attack-deg`, "
      "levels out at `depth`, is dragged `drag` at `speed`, curls by `curl-deg`, goes up by "
      "`depth` and `lift` and "
      "holds. `refine` yes repeats it at half the cell and compares mean force of the drag and "
      "load.";
  rig.parameters = scoop_parameters();
  rig.parameters.push_back(yes_no("refine", false, "also at half the cell", "one run"));
  rig.headline = {"mean horizontal force of the drag", "load", "held force over the load's weight",
                  "drag over an upright wedge of the depth"};
  rig.examples = {{"Two cells and two steps in one table, with a picture",
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
      "The bucket's floor is pressed `press` into level resting ground in 0.2 s, dragged `drag` at "
      "`speed` and "
      "lifted; soil wakes and is deposited by itself. The drag's second half is held against the "
      "same with crowding "
      "off, "
      "its vertical force against the weight of the load.";
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
      "The bucket's path of rig `bucket` on ground that wakes and takes soil back by itself, "
      "`cycles` times, each "
      "`step-down` deeper; every load is carried `dump` to the side and tipped by 130 degrees.";
  rig.parameters = scoop_parameters();
  rig.parameters.push_back({"cycles", 3, "", "in all", count_from(1)});
  rig.parameters.push_back({"step-down", 0.15, "m", "per cycle", above(0)});
  rig.parameters.push_back({"dump", 2.5, "m", "to the side", above(0)});
  rig.default_soil = clean_sand(35);
  rig.experiment = run_cycle;
  return rig;
}

}  // namespace navvy::lab
