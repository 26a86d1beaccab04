// SPDX-License-Identifier: Apache-2.0
// Rigs `hold` (a bucket with its resting load) and `light-tool` (a plate lighter than the soil it
// falls on).
//
// A load at rest in a bucket has a known weight: the mean force must be right to a percent and must
// not drift, for any step. With a shell lighter than its load the exchange of impulses is two-way
// and stiff; an explicit solution would chatter at several g. The light plate tests a contact that
// opens and closes: it must not gain energy for any ratio of masses.
#include <algorithm>
#include <cmath>

#include "lab/rig_shapes.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Buckets and carried loads]";

// Of the held box [m].
constexpr double kLength = 1.0, kWidth = 0.8;

/// Returns the load, level in the tilted box, up to the wanted mass.
std::vector<soil::Particle> load_of(const Site& site, const Pose& X, double mass, double& height) {
  std::vector<soil::Particle> out;
  // A quarter of a cell off the walls' faces, so that the load does not start pressed against them.
  const double h = site.cell() / 2, wall = 0.015 + 0.25 * site.cell();
  const double grain = site.soil().bank_density * h * h * h;
  double sum = 0;
  // Layer by layer, the last one up to the mass.
  for (height = wall; sum < mass; height += h)
    for (double y = -kWidth / 2 + wall; y <= kWidth / 2 - wall + 1e-9; y += h)
      for (double x = -kLength / 2 + wall; x <= kLength / 2 - wall + 1e-9 && sum < mass;
           x += h, sum += grain)
        out.push_back(site.particle(X * Vec3(x, y, height), h * h * h));
  return out;
}

/// In the ledger's whole quanta, so that a later loss compares exactly [kg].
double mass_of(const std::vector<soil::Particle>& soil) {
  std::int64_t sum = 0;
  for (const soil::Particle& p : soil) sum += p.mass;
  return kilograms(sum);
}

/// Unweighted: all particles of a load are alike [m].
Vec3 middle_of(const Site& site) {
  Vec3 sum = Vec3::Zero();
  const auto soil = site.solver().particles();
  for (const soil::Particle& p : soil) sum += site.position(p);
  return sum / std::max<double>(1, static_cast<double>(soil.size()));
}

/// Models a servo that carries shell and load at `start` with `hertz`, nearly critically damped.
void hang(Tool& tool, const Pose& start, double load, double hertz) {
  // Rotation is held as by springs and dampers on an arm whose square is `arm2` [m2].
  const double omega = 2 * kPi * hertz, all = tool.mass + load, arm2 = 0.3;
  // Of shell and load together: a servo tuned for the shell alone would sag.
  const double stiffness = all * omega * omega, damping = 1.4 * all * omega;
  const Eigen::AngleAxisd turn(tool.motion.X_WT.linear() * start.linear().transpose());
  tool.force_W = -stiffness * (tool.motion.X_WT.translation() - start.translation()) -
                 damping * tool.motion.v_WT + Vec3(0, 0, all * kGravity);
  tool.torque_W = -arm2 * (stiffness * turn.angle() * turn.axis() + damping * tool.motion.w_WT);
}

/// Holds the loaded box in the air and records force and load.
Report run_hold(const Setup& setup) {
  SiteOptions options;
  options.size = 8;
  options.depth = 1;
  Site site(setup, options);
  // In the air and off the grid's planes: the ground has no effect.
  const Pose X = make_pose(0.03, 0.02, 1.5, 0, radians(setup["tilt-deg"]), 0);
  double height = 0;
  const auto soil = load_of(site, X, setup["mass"], height);
  ToolDriver driver(site, open_box(kLength, kWidth, height + 0.2), X);
  Tool& tool = site.tool(driver.tool());
  site.solver().insert(soil);
  const double load = mass_of(soil), weight = load * kGravity;
  tool.mass = setup["shell-mass"];
  // A box of 1.0 x 0.8 x 0.6 m, hollow or not: the servo is much stiffer than the difference.
  tool.inertia = tool.mass / 12 * Vec3(1.0, 1.36, 1.64);
  const double seconds = setup["time"], dt = setup["step-share"] * site.step_limit(0.5);
  site.expect(seconds);
  double before = 0, most = 0, fastest = 0;
  Vec3 sum = Vec3::Zero(), middle = Vec3::Zero();
  const int steps = static_cast<int>(std::ceil(seconds / dt)), settled = steps / 5;
  for (int i = 0; i < steps; ++i) {
    // A fixed tool needs no servo: a scripted tool keeps its twist, which is zero.
    if (tool.mass > 0) hang(tool, X, load, setup["servo-hz"]);
    driver.step(dt);
    if (i == settled) {
      // The start shakes a few particles out; drift is what continues after that.
      before = site.solver().payload(driver.tool(), driver.pose());
      middle = middle_of(site);
    }
    if (i <= settled) continue;
    // Means show the weight, the largest single step shows chatter.
    sum += driver.trace().force.back();
    most = std::max(most, std::abs(-driver.trace().force.back().z() / weight - 1));
    fastest = std::max(fastest, tool.motion.v_WT.norm());
  }
  // Steps are equal, so the plain mean is the mean over time.
  const Vec3 force = sum / (steps - settled - 1);
  // Counted inside the shell at the end.
  const double held = site.solver().payload(driver.tool(), driver.pose());
  Report report;
  report.add("mean vertical force over the load's weight", -force.z() / weight, "", 1, 0.998, 1.002,
             kSource);
  report.add("horizontal force over the weight", std::hypot(force.x(), force.y()) / weight, "", 0,
             kNone, 0.01, std::string("statics ") + kSource);
  report.add("largest step's deviation", 100 * most, "% of weight", 0, kNone, kNone,
             "after the first fifth");
  report.add("load lost", load - held, "kg", 0, kNone, 0.01 * load,
             std::string("no drift ") + kSource);
  report.note("load lost after the first fifth", before - held, "kg");
  report.note("drift of the load's middle",
              1000 * (middle_of(site) - middle).norm() / (0.8 * seconds), "mm/s");
  // Chatter that cancels in the mean shows as speed.
  report.note("fastest motion of the shell", fastest, "m/s", "two-way only");
  report.note("load", load, "kg");
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  site.finish(report);
  return report;
}

/// Drops the plate on a bed and records its energy at every step.
Report run_light(const Setup& setup) {
  const double cell = setup.cell, edge = setup["edge"];
  // Three cells beside the plate and four below it: the ground's edge has no effect.
  const double side = cell * std::ceil((edge / 2 + 3 * cell) / cell);
  const SiteBox bed{Vec3(-side, -side, -4 * cell), Vec3(side, side, 0)};
  SiteOptions options;
  options.size = 2 * (side + 4 * cell);
  options.depth = 12 * cell;
  options.surface = pit(bed);
  Site site(setup, options);
  auto soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);
  // The cells it touches: half a cell of soil under it.
  const double touched = setup.soil.bank_density * edge * edge * cell;
  const double start = setup["height"];
  const scene::Shell shell = plate(edge, edge);
  // A little tilted: it lands on an edge, the harder case.
  ToolDriver driver(site, shell, make_pose(0.02, 0.01, start, 0, radians(4), 0));
  Tool& tool = site.tool(driver.tool());
  tool.mass = setup["mass-ratio"] * touched;
  // A thin square plate.
  tool.inertia = tool.mass * edge * edge / 12 * Vec3(1, 1, 2);
  tool.motion.v_WT = Vec3(0, 0, -setup["speed"]);
  // Height is relative to W's origin, the ground's surface, so that the ratio below is of energies
  // above rest.
  const auto energy = [&tool] {
    const soil::ToolMotion& m = tool.motion;
    const Vec3 w = m.X_WT.linear().transpose() * m.w_WT;
    return 0.5 * tool.mass * m.v_WT.squaredNorm() + 0.5 * w.dot(tool.inertia.cwiseProduct(w)) +
           tool.mass * kGravity * m.X_WT.translation().z();
  };
  const double first = energy();
  double most = 0;
  site.expect(setup["time"]);
  // At the speed of the fall; the plate is never much faster.
  const double dt = site.step_limit(setup["speed"]);
  for (double t = 0; t < setup["time"]; t += dt) {
    driver.step(dt);
    most = std::max(most, energy());
  }
  Report report;
  // An explicit exchange of impulses pushes a light plate away faster than it came.
  report.add("highest energy over the energy at the start", most / first, "", 1, kNone, 1.01,
             std::string("no growth ") + kSource);
  report.add("speed at the end", tool.motion.v_WT.norm(), "m/s", 0, kNone, 0.02,
             std::string("at rest ") + kSource);
  report.note("mass of the plate", tool.mass, "kg");
  // The stand-off is that of its lower face, half a thickness under the centre.
  const double z = tool.motion.X_WT.translation().z();
  report.add("stand-off of the plate at rest", (z - shell.half_thickness) / cell, "cells", 0, kNone,
             0.5, std::string("on the soil, not over it ") + kSource);
  report.note("rests at", 1000 * z, "mm", "its middle, over the ground");
  report.note("momentum residual", site.worst_residual(), "", "of the sum of impulses; 1e-5");
  site.finish(report);
  return report;
}

}  // namespace

Rig hold_rig() {
  Rig rig;
  rig.name = "hold";
  rig.summary = "a held bucket carries the weight of its resting load";
  rig.drawing =
      "An open box of 1.0 x 0.8 m, tilted by `tilt-deg` and loaded with `mass` of soil, is held "
      "in the air for `time`. The force is the mean after the first fifth. With `shell-mass` 0 "
      "the box is fixed; with more it is free and held by a servo of `servo-hz` that carries "
      "shell and load. `step-share` is the step as a share of the stable step.";
  rig.parameters = {{"mass", 500, "kg", "of the load", above(0)},
                    {"tilt-deg", 10, "deg", "of the box", at_least(0)},
                    {"time", 10, "s", "held", above(0)},
                    {"shell-mass", 0, "kg", "of the box; 0: fixed", at_least(0)},
                    {"servo-hz", 2, "Hz", "of shell and load", above(0)},
                    {"step-share", 1, "", "of the stable step", above(0)}};
  rig.examples = {{"A load of 1.4 t in a shell of 0.7 t", "--mass 1400 --shell-mass 700"}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_hold;
  return rig;
}

Rig light_tool_rig() {
  Rig rig;
  rig.name = "light-tool";
  rig.summary = "a plate lighter than the soil it touches falls on soil and gains no energy";
  rig.drawing =
      "A square plate of `edge`, tilted by 4 degrees, falls on a bed from `height` at `speed`. It "
      "is `mass-ratio` times as heavy as the layer of one cell under it. Its kinetic and "
      "potential energy must never exceed the initial one by more than 1 % (one step of gravity "
      "before the first contact), and it must come to rest. It may stand off by half a cell: the "
      "distance between its lower face, at its centre, and the nominal ground.";
  rig.parameters = {
      {"edge", 0.6, "m", "of the plate", above(0)},
      {"mass-ratio", 0.1, "", "mass over that of the soil layer it touches", above(0)},
      {"height", 0.08, "m", "over the ground at the start", at_least(0)},
      {"speed", 0.5, "m/s", "downwards at the start", above(0)},
      {"time", 1.2, "s", "in all", above(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_light;
  return rig;
}

}  // namespace navvy::lab
