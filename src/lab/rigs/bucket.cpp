// SPDX-License-Identifier: Apache-2.0
// Rigs `bucket` (fill along a path), `scrape` (flat on level ground), `cycle` (dig and dump at one place).
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "lab/rigs/tool_list.h"
#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

/// Profile of a bucket of unit size: lip, end of the floor, heel, back, rim; the mouth looks ahead and up.
const std::vector<Vec2>& profile() {
  static const std::vector<Vec2> points = {{0, 0}, {-0.6, 0}, {-0.8, 0.15}, {-0.8, 0.5}, {-0.55, 0.7}};
  return points;
}

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
  Bucket(double width_in, double volume) : width(width_in), size(std::sqrt(volume / (width_in * profile_area()))) {}
  scene::Shell shell() const {
    scene::Shell s;
    s.name = "bucket";
    for (const Vec2& p : profile()) {
      s.vertices.emplace_back(size * p.x(), -width / 2, size * p.y());
      s.vertices.emplace_back(size * p.x(), width / 2, size * p.y());
    }
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

double loose_volume(const scene::Soil& soil, double mass) { return mass / soil.bank_density * soil.swell; }

/// Turns the bucket about its lip by `angle` [rad] (positive: mouth up) while the lip moves by `travel`.
Vec3 turn(ToolDriver& driver, double angle, const Vec3& travel, double seconds) {
  driver.set_twist(travel / seconds, Vec3(0, -angle / seconds, 0));
  return driver.run(seconds);
}

/// Lip down at `attack`, level drag, curl, lift: `fill` returns the mean horizontal force of the drag [N].
struct Scoop {
  double depth, drag, speed, attack, curl, lift;
  double fill(ToolDriver& driver) const {
    const double in = depth / std::tan(attack);
    driver.advance(std::hypot(in, depth), speed * Vec3(std::cos(attack), 0, -std::sin(attack)));
    turn(driver, attack, Vec3(0.5 * attack * speed, 0, 0), 0.5 * attack);  // floor level, one rad/s or two
    const Vec3 force = driver.advance(drag, Vec3(speed, 0, 0));
    turn(driver, curl, Vec3(0.35 * depth, 0, 1.2 * depth), curl);
    driver.advance(lift, Vec3(0, 0, 0.8));
    return -force.x();
  }
  double seconds() const { return (depth / std::sin(attack) + drag) / speed + 0.5 * attack + curl + lift / 0.8; }
};

Scoop scoop_of(const Setup& setup) {
  std::vector<Fault> faults;
  const auto within = [&](const char* name, double low, double high) {
    const double value = setup[name];
    if (value < low || value > high)
      faults.push_back(
          Fault{Fault::Severity::kError, "", 0, name, std::to_string(value),
                std::to_string(static_cast<int>(low)) + " .. " + std::to_string(static_cast<int>(high)) + " degrees",
                "30 and 50 are usual"});
  };
  within("attack-deg", 10, 80);
  within("curl-deg", 1, 120);
  if (!faults.empty()) throw InputError(faults);
  return {setup["depth"],
          setup["drag"],
          setup["speed"],
          radians(setup["attack-deg"]),
          radians(setup["curl-deg"]),
          setup["depth"] + setup["lift"]};
}

struct Filled {
  double force = 0, payload = 0, held = 0;
};

Filled run_fill(const Setup& setup, double cell, Report& report, bool write) {
  const Bucket bucket(setup["width"], setup["volume"]);
  const Scoop scoop = scoop_of(setup);
  const auto whole = [cell](double x) { return cell * std::ceil(x / cell - 1e-9); };
  const double reach = scoop.depth / std::tan(scoop.attack) + scoop.drag + 1.0 + 2 * scoop.depth,
               side = bucket.width / 2 + 1.5 * scoop.depth;
  const Box bed{Vec3(-0.5, -whole(side), -whole(scoop.depth + 0.3)), Vec3(whole(reach), whole(side), 0)};
  SiteOptions options;
  options.size = 2 * (reach + 1);
  options.depth = scoop.depth + 0.3 + 1;
  options.surface = pit(bed);
  Site site(*setup.device, {setup.soil}, cell, options);
  auto soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);
  ToolDriver driver(site, bucket.shell(), make_pose(0, 0.07 * cell, 0.02, 0, scoop.attack, 0));
  Filled out;
  out.force = scoop.fill(driver);
  driver.set_twist(Vec3::Zero());
  driver.run(0.6);
  const Vec3 force = driver.run(0.4);
  out.payload = site.solver().payload(driver.tool(), driver.pose());
  out.held = force.z() / (-out.payload * kGravity);
  out.held = std::abs(out.held);
  if (write) driver.write(report, setup["speed"] / (2 * cell));
  report.note("particles through the shell", static_cast<double>(site.solver().stats().shell_crossings), "");
  site.finish(report);
  return out;
}

Report run_bucket(const Setup& setup) {
  Report report;
  const Filled coarse = run_fill(setup, setup.cell, report, true);
  const double volume = loose_volume(setup.soil, coarse.payload);
  report.note("mean horizontal force of the drag", coarse.force, "N");
  report.note("load", coarse.payload, "kg");
  report.add("held force over the load's weight", coarse.held, "", 1, 0.98, 1.02, "held bucket, grains may fall");
  report.note("loose volume over struck volume", volume / setup["volume"], "");
  const BladeCase wedge{setup.soil.friction_angle,
                        setup.soil.tool_friction_angle,
                        kPi / 2,
                        setup["depth"],
                        setup["width"],
                        setup.soil.bank_density * kGravity,
                        setup.soil.cohesion,
                        0,
                        0};
  report.add("drag over an upright wedge of the depth", coarse.force / reece_wedge(wedge).horizontal, "", kNone, kNone,
             kNone, "Reece 1964, for scale");
  if (setup.whole("refine") != 1) return report;
  const Filled fine = run_fill(setup, setup.cell / 2, report, false);
  report.add("force over the run at half the cell", coarse.force / fine.force, "", 1, 0.75, 1.25, "VALIDATION 3");
  report.add("volume over the run at half the cell", coarse.payload / fine.payload, "", 1, 0.94, 1.06, "VALIDATION 3");
  return report;
}

/// Highest change of the ground's surface outside the bucket's path [m].
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

Report run_scrape(const Setup& setup) {
  const Bucket bucket(setup["width"], setup["volume"]);
  SiteOptions options;
  options.size = 2 * (setup["drag"] + 4);
  options.depth = 2;
  options.exchange = true;
  Site site(setup, options);
  const double press = setup["press"], drag = setup["drag"], speed = setup["speed"];
  ToolDriver driver(site, bucket.shell(), make_pose(0, 0.07 * setup.cell, 0.015 + 0.01));
  site.expect(0.2 + drag / speed + 4);
  const Vec3 pressing = driver.advance(press + 0.01, Vec3(0, 0, -(press + 0.01) / 0.2));
  driver.advance(0.5 * drag, Vec3(speed, 0, 0));
  const Vec3 dragging = driver.advance(0.5 * drag, Vec3(speed, 0, 0));
  const double load = site.solver().payload(driver.tool(), driver.pose());
  driver.advance(0.8, Vec3(0, 0, 0.8));
  const double fastest = site.solver().stats().max_speed;
  driver.set_twist(Vec3::Zero());
  driver.run(3);
  const scene::Soil& s = setup.soil;
  BladeCase wedge{s.friction_angle,
                  s.tool_friction_angle,
                  kPi / 2,
                  press + setup.cell,
                  bucket.width,
                  s.bank_density * kGravity,
                  s.cohesion,
                  s.adhesion,
                  0};
  const double bound = 3 * (reece_wedge(wedge).horizontal + std::tan(s.tool_friction_angle) * load * kGravity);
  Report report;
  report.add("drag, second half", -dragging.x(), "N", bound / 3, kNone, bound,
             "3 x wedge of press + 1 cell and friction of the load; VALIDATION 3");
  report.note("vertical force while pressing, mean", pressing.z(), "N");
  report.note("vertical force, second half of the drag", dragging.z(), "N");
  report.add("fastest soil when the bucket lifts off", fastest, "m/s", speed, kNone, 3 * speed, "no energy gain");
  report.add("ground outside the path", 1000 * change_outside(site.ground(), bucket.width, drag), "mm", 0, kNone,
             1000 * setup.cell, "one cell; VALIDATION 3");
  report.note("soil in the bucket at the end of the drag", load, "kg");
  report.note("particles through the shell", static_cast<double>(site.solver().stats().shell_crossings), "");
  report.add("ledger", static_cast<double>(site.solver().ledger().error()), "quanta", 0, 0, 0, "closed");
  driver.write(report, speed / (2 * setup.cell));
  site.finish(report);
  return report;
}

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
  site.expect(count * (scoop.seconds() + 2 * away / 3 + 5));
  Series volumes{"loose volume over struck volume", "", {}}, forces{"mean drag", "N", {}};
  double ledger = 0, sum = 0;
  for (int i = 0; i < count; ++i) {
    const Pose home = make_pose(0, 0.07 * setup.cell, 0.02 - i * setup["step-down"], 0, scoop.attack, 0);
    site.tool(driver.tool()).motion.X_WT = home;  // in the air over the hole
    forces.values.push_back(scoop.fill(driver));
    driver.advance(1.0 + i * setup["step-down"], Vec3(0, 0, 1));
    driver.set_twist(Vec3::Zero());
    driver.run(0.3);
    const double mass = site.solver().payload(driver.tool(), driver.pose());
    volumes.values.push_back(loose_volume(setup.soil, mass) / setup["volume"]);
    sum += volumes.values.back();
    driver.advance(away, Vec3(0, 3, 0));
    turn(driver, -radians(130), Vec3::Zero(), 1.3);
    driver.set_twist(Vec3::Zero());
    driver.run(1.2);
    turn(driver, radians(130), Vec3(0, 0, 0.8), 1.0);
    driver.advance(away, Vec3(0, -3, 0));
    ledger += std::abs(static_cast<double>(site.solver().ledger().error()));
  }
  driver.set_twist(Vec3::Zero());
  driver.run(2);
  Report report;
  report.add("loose volume over struck volume, mean", sum / count, "", kNone, kNone, kNone,
             "moist loam 1.00 .. 1.10 with an operator's path; VALIDATION 3");
  report.note("first cycle", volumes.values.front(), "");
  report.note("last cycle", volumes.values.back(), "");
  report.add("ledger, summed over cycles", ledger, "quanta", 0, 0, 0, "exact; VALIDATION 1");
  report.note("wakes", static_cast<double>(site.solver().stats().wakes), "");
  report.note("deposits", static_cast<double>(site.solver().stats().deposits), "");
  report.note("particles at the end", site.solver().stats().particles, "");
  report.note("particles through the shell", static_cast<double>(site.solver().stats().shell_crossings), "");
  report.series = {volumes, forces};
  site.finish(report);
  return report;
}

std::vector<Parameter> scoop_parameters() {
  return {{"width", 0.8, "m", "of the bucket"},
          {"volume", 0.3, "m3", "struck, of the bucket"},
          {"depth", 0.25, "m", "of the lip in the drag"},
          {"drag", 0.8, "m", "level"},
          {"speed", 0.8, "m/s", "of the lip"},
          {"attack-deg", 30, "deg", "of the floor as the lip goes in"},
          {"curl-deg", 50, "deg", "by which it turns up behind the drag"},
          {"lift", 0.4, "m", "behind the curl, over and above `depth`"}};
}

}  // namespace

Rig bucket() {
  Rig rig;
  rig.name = "bucket";
  rig.summary = "bucket filled along a path: force and load, against half the cell";
  rig.drawing =
      "A bucket (flat floor, heel, back, two sides, 30 mm plates) goes into a bed with its floor at `attack-deg`, "
      "levels out at `depth`, is dragged `drag` at `speed`, curls by `curl-deg`, goes up by `depth` and `lift` and "
      "holds. Refine 1 repeats it at half "
      "the cell and compares mean force of the drag and load.";
  rig.parameters = scoop_parameters();
  rig.parameters.push_back({"refine", 0, "", "1: also at half the cell"});
  rig.default_soil = clean_sand(35);
  rig.run = run_bucket;
  return rig;
}

Rig scrape() {
  Rig rig;
  rig.name = "scrape";
  rig.summary = "bucket pressed flat on level ground and dragged: no jam, no gain of energy";
  rig.drawing =
      "The bucket's floor is pressed `press` into level resting ground in 0.2 s, dragged `drag` at `speed` and lifted; "
      "soil wakes and is deposited by itself. The drag's second half is held against three times the wedge of the "
      "pressed depth and one cell plus friction of the soil that lies in the bucket.";
  rig.parameters = {{"width", 0.8, "m", "of the bucket"},
                    {"volume", 0.3, "m3", "struck, of the bucket"},
                    {"press", 0.05, "m", "into the ground"},
                    {"drag", 1, "m", "level"},
                    {"speed", 1, "m/s", "of the drag"}};
  rig.default_soil = clean_sand(35);
  rig.run = run_scrape;
  return rig;
}

Rig cycle() {
  Rig rig;
  rig.name = "cycle";
  rig.summary = "dig and dump several times at one place: volume per pass, ledger";
  rig.drawing =
      "The bucket's path of rig `bucket` on ground that wakes and takes soil back by itself, `cycles` times, each "
      "`step-down` deeper; every load is carried `dump` to the side and tipped by 130 degrees.";
  rig.parameters = scoop_parameters();
  rig.parameters.push_back({"cycles", 3, "", "in all"});
  rig.parameters.push_back({"step-down", 0.15, "m", "per cycle"});
  rig.parameters.push_back({"dump", 2.5, "m", "to the side"});
  rig.default_soil = clean_sand(35);
  rig.run = run_cycle;
  return rig;
}

}  // namespace navvy::lab
