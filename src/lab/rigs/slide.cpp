// SPDX-License-Identifier: Apache-2.0
// Rig `slide`: a block on a plane with Coulomb friction, first a block of soil, then a rigid plate
// on soil.
//
// This tests the friction of the contact by itself, without yield of soil: the block is too strong
// to shear. First the soil moves and the steel is fixed, then the steel moves and the soil rests.
// The two take different paths through the contact, and both must give Coulomb's acceleration.
// Adhesion acts on the whole face without normal force, so that a bonded block decelerates by
// adhesion x area / mass.
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"

namespace navvy::lab {
namespace {

const char* const kSource = " [docs/validation.md, Element and law]";

/// Gravity is tilted, not the plane: faces stay aligned with the grid for every angle.
SiteOptions tilted(const Setup& setup) {
  const double angle = radians(setup["tilt-deg"]);
  SiteOptions out;
  out.size = 80 * setup.cell;
  out.depth = 10 * setup.cell;
  out.gravity = kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
  return out;
}

/// Returns the slope of speed over time in the second half of the run, when the block has settled
/// on its plane [m/s2].
double acceleration(const std::vector<double>& time, const std::vector<double>& speed) {
  const auto half = static_cast<std::ptrdiff_t>(time.size() / 2);
  return fit_line({time.begin() + half, time.end()}, {speed.begin() + half, speed.end()}).b;
}

/// Runs a block of cohesive soil on a steel plate above the ground.
double slide_soil(const Setup& setup, Report& report) {
  const double cell = setup.cell;
  SiteOptions options = tilted(setup);
  // The steel is in the air: the block touches only the plate.
  options.surface = [cell](double, double) { return -8 * cell; };
  Site site(setup, options);
  site.expect(2 * setup["time"]);
  // Off the grid's planes in y and z, as any plate is.
  const int tool =
      site.add_tool(plate(70 * cell, 24 * cell), make_pose(0, 0.07 * cell, 0.03 * cell));
  // Above the plate's half thickness and position: the block starts just out of contact and
  // settles.
  const double thick = 0.015 + 0.03 * cell, x = 20 * cell;
  auto block = site.fill(
      {Vec3(-x - 6 * cell, -4 * cell, thick), Vec3(-x + 6 * cell, 4 * cell, thick + 5 * cell)});
  site.rest(block, thick + 5 * cell);
  site.solver().insert(block);
  Series time{"time", "s", {}}, speed{"speed of the soil block", "m/s", {}};
  double friction = 0, normal = 0;
  for (int i = 0; i < 20; ++i) {
    site.run(setup["time"] / 20, [&] {
      const soil::ToolImpulse& impulse = site.tool(tool).impulse;
      if (site.time() < 0.5 * setup["time"]) return;
      // Sums of impulses, so that a ringing contact still gives a clean ratio.
      friction += impulse.J_W.x();
      normal -= impulse.J_W.z();
    });
    // The mean of all particles: the block shears a little as it settles.
    double sum = 0, count = 0;
    for (const soil::Particle& p : site.solver().particles())
      sum += static_cast<double>(p.v[0]), count += 1;
    time.values.push_back(site.time());
    speed.values.push_back(sum / count);
  }
  // On 12 x 8 cells.
  const double adhesion = setup.soil.adhesion * 96 * cell * cell * 0.5 * setup["time"];
  report.add("soil block, shear without adhesion x area over normal force",
             (friction - adhesion) / normal, "", std::tan(setup.soil.tool_friction_angle), kNone,
             kNone, "tan delta");
  report.series = {time, speed};
  site.finish(report);
  return acceleration(time.values, speed.values);
}

/// Runs a rigid plate with the weight of a block on a bed of cohesive soil.
double slide_plate(const Setup& setup, Report& report) {
  const double cell = setup.cell, half = 34 * cell, wide = 9 * cell;
  // Five cells deep: the nodes of a cell at the floor are not those under the plate.
  const SiteBox bed{Vec3(-half, -wide, -5 * cell), Vec3(half, wide, 0)};
  SiteOptions options = tilted(setup);
  options.surface = pit(bed);
  Site site(setup, options);
  site.expect(2 * setup["time"]);
  auto soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);
  const double length = 12 * cell, width = 8 * cell;
  const int tool =
      site.add_tool(plate(length, width), make_pose(-20 * cell, 0.07 * cell, 0.015 + 0.02 * cell));
  Tool& block = site.tool(tool);
  // No inertia is needed: the plate does not rotate.
  block.mass = setup["pressure"] * length * width / kGravity;
  block.lock_rotation = true;
  Series time{"time", "s", {}}, speed{"speed of the plate", "m/s", {}};
  // [N s] in the second half.
  double shear = 0, normal = 0;
  for (int i = 0; i < 20; ++i) {
    site.run(setup["time"] / 20, [&] {
      if (site.time() < 0.5 * setup["time"]) return;
      shear -= block.impulse.J_W.x();
      normal += block.impulse.J_W.z();
    });
    time.values.push_back(site.time());
    speed.values.push_back(block.motion.v_WT.x());
  }
  const double bond = setup.soil.adhesion * length * width * 0.5 * setup["time"];
  const double most = bond + std::tan(setup.soil.tool_friction_angle) * normal;
  const double tilt = radians(setup["tilt-deg"]), rub = std::tan(setup.soil.tool_friction_angle);
  const bool slides =
      setup["pressure"] * (std::sin(tilt) - rub * std::cos(tilt)) > setup.soil.adhesion;
  // Without friction and adhesion there is no bound to compare the shear with.
  if (most > 0)
    report
        .add("rigid plate, shear over adhesion x area + tan delta x normal force", shear / most, "",
             1, 0.95, 1.05, std::string("Coulomb with adhesion") + kSource)
        .holds_for("a plane so steep that the plate slides", slides);
  report.note("plate, sunk by", 1000 * (0.015 + 0.02 * cell - block.motion.X_WT.translation().z()),
              "mm");
  report.series.push_back(speed);
  site.finish(report);
  return acceleration(time.values, speed.values);
}

/// Runs both blocks in sequence, with the same closed form.
Report run(const Setup& setup) {
  Report report;
  const double angle = radians(setup["tilt-deg"]);
  // Coulomb friction on an inclined plane.
  const double expected =
      kGravity * (std::sin(angle) - std::tan(setup.soil.tool_friction_angle) * std::cos(angle));
  const double soil = slide_soil(setup, report), rigid = slide_plate(setup, report);
  // Adhesion on the face decelerates by a A / m: the soil block is 5 cells high, the plate weighs
  // `pressure`.
  const double a = setup.soil.adhesion,
               soil_expected = expected - a / (setup.soil.bank_density * 5 * setup.cell),
               plate_expected = expected - a * kGravity / setup["pressure"];
  const std::string source =
      std::string(a > 0 ? "g (sin - mu cos) - a A / m" : "g (sin - mu cos)") + kSource;
  // Two percent of the acceleration without adhesion: a bond may make the net one arbitrarily
  // small.
  const auto row = [&](const char* name, double measured, double right) {
    report
        .add(name, measured, "m/s2", right, right - 0.02 * expected, right + 0.02 * expected,
             source)
        .holds_for("a plane so steep that the block slides", right > 0);
  };
  row("soil block, acceleration", soil, soil_expected);
  row("rigid plate, acceleration", rigid, plate_expected);
  return report;
}

}  // namespace

Rig slide_rig() {
  Rig rig;
  rig.name = "slide";
  rig.summary =
      "block on a plane with Coulomb friction: a block of soil on steel, a rigid plate on soil";
  rig.drawing =
      "Gravity is tilted by `tilt-deg`. First a block of strong cohesive soil, 12 x 8 x 5 cells, "
      "slides on a steel plate; then a rigid plate of 12 x 8 cells with weight `pressure` slides "
      "on a bed of the same soil, 5 cells deep. The friction angle of both is the soil's delta, "
      "the shear without normal force its adhesion. The acceleration is the slope of the speed in "
      "the second half of `time`.";
  rig.parameters = {{"tilt-deg", 30, "deg", "of gravity", between(0, 90)},
                    {"pressure", 2000, "Pa", "weight of the plate over its area", above(0)},
                    {"time", 0.8, "s", "each", above(0)}};
  rig.default_soil = cohesive(30, 20000);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
