// SPDX-License-Identifier: Apache-2.0
// Rigs `footing` (bearing capacity of a strip, plane strain) and `plate` (pressure and sinkage of a
// plate).
//
// A strip pressed into weightless soil has an exact limit load: 5.14 c for clay, and Nq times a
// surcharge beside it. Only weightless soil makes it exact, so gravity is off or very small. Zero
// dilatancy reduces Nq of a frictional soil below its associated value, to about that of Davis's
// angle; the tolerances cover both ends. The shell acts on soil up to a cell away, so it is made
// narrower by an offset. The plate on real ground gives the pressure-sinkage curve of wheel
// formulas; the law of the particles was not fitted to it.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/chute.h"
#include "lab/rigs/heap.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/formulas.h"
#include "terramechanics/plate.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Footings and plates]";

/// The surcharge layer: thickness [cells] and density, and the density of the soil under it
/// [kg/m3]. Gravity is scaled so that the layer has the wanted weight; the soil's own weight is
/// then small beside it.
constexpr double kLayerCells = 2, kLayerDensity = 19000, kSoilDensity = 190;

/// Lengths of the experiment, soil in whole cells [m].
struct Strip {
  double breadth, gap, ahead, below, settlement;
};

Strip strip_of(const Setup& setup) {
  const double cell = setup.cell, breadth = setup["breadth"];
  return {breadth, 4 * cell, whole_cells(setup["beside"] * breadth, cell),
          whole_cells(setup["below"] * breadth, cell), setup["settlement"] * breadth};
}

/// Returns smooth soil and a strengthless layer above it; without surcharge there is no layer.
std::vector<scene::Soil> strip_soils(const Setup& setup) {
  scene::Soil soil = chute_soils(setup.soil)[1];
  // Nearly weightless beside its surcharge, as the factor Nq is defined.
  if (setup["surcharge-pa"] > 0) soil.bank_density = kSoilDensity;
  // The layer only weighs: its strength would add to the result.
  scene::Soil layer = soil;
  layer.name = "surcharge";
  layer.bank_density = kLayerDensity;
  // Practically a liquid.
  layer.friction_angle = radians(0.5);
  layer.cohesion = layer.residual_cohesion = 0;
  return {soil, layer};
}

/// Adds soil at rest under its surcharge, and the layer beside the place of the footing, at rest
/// under its own weight.
void place_footing(Site& site, const Strip& strip, double surcharge) {
  const double cell = site.cell(), y = chute_offset(cell), low = -strip.ahead - strip.breadth / 2,
               high = -low;
  // Only in the chute, not in the pit's margin outside the plates.
  auto bed = site.fill({Vec3(low, y, -strip.below), Vec3(high, y + strip.gap, 0)});
  site.rest(bed, 0.0, surcharge);
  site.solver().insert(bed);
  if (!(surcharge > 0)) return;
  const double top = kLayerCells * cell;
  // A tenth of a cell off the stem; otherwise the first row would start inside its reach.
  const auto beside = [&](const Vec3& p) {
    return std::abs(p.x()) > strip.breadth / 2 + 0.1 * cell;
  };
  auto layer = site.fill({Vec3(low, y, 0), Vec3(high, y + strip.gap, top)}, beside, 1);
  const double weight = site.soil(1).bank_density * -site.world().gravity.z();
  for (soil::Particle& p : layer)
    p.j = static_cast<float>(p.j0 * (1 - weight * (top - site.position(p).z()) / 833e3));
  site.solver().insert(layer);
}

/// Returns the pit, and the gravity that makes the factor one of strength alone.
SiteOptions strip_site(const Setup& setup, const Strip& strip) {
  const double cell = setup.cell, half = strip.ahead + strip.breadth / 2, q = setup["surcharge-pa"];
  // No wider than the soil needs: the ground around it is at rest and costs nothing.
  SiteOptions out;
  out.energy = setup.energy;
  out.size = 2 * (half + 6 * cell);
  out.depth = strip.below + 8 * cell;
  out.surface = pit({Vec3(-half, -2 * cell, -strip.below), Vec3(half, strip.gap + 3 * cell, 0)});
  const double layer = kLayerDensity * kLayerCells * cell;
  out.gravity = q > 0                           ? Vec3(0, 0, -q / layer)
                : setup.is("weightless", "yes") ? Vec3(Vec3::Zero())
                                                : Vec3(0, 0, -kGravity);
  return out;
}

/// Reads the factor of the load case: Nq under a surcharge, Nc without. Tolerances apply to the
/// angles whose bounds by associated flow and by zero dilatancy are known.
void judge(const Setup& setup, double pressure, Report& report) {
  const double phi = setup.soil.friction_angle, c = setup.soil.cohesion, q = setup["surcharge-pa"];
  if (q > 0) {
    double low = kNone, high = kNone;
    if (std::abs(degrees(phi) - 20) < 0.01) low = 5.3, high = 6.7;
    if (std::abs(degrees(phi) - 30) < 0.01) low = 11.7, high = 19.3;
    const double nq = (pressure - c * bearing_nc(phi)) / q, d = davis_angle(phi);
    report
        .add("Nq", nq, "", bearing_nq(phi), low, high,
             std::string("[Reissner 1924], associated flow ") + kSource)
        .holds_for("phi 20 or 30", !std::isnan(low));
    report.add("Nq against Davis", nq, "", bearing_nq(d), kNone, kNone,
               "[Davis 1968], zero dilatancy");
    return;
  }
  // Only this case has a solution without assumptions; with friction, weight or flow rule matter.
  const bool exact = phi < 1e-6 && setup.is("weightless", "yes");
  const double nc = bearing_nc(phi);
  report
      .add("Nc = pressure / c", pressure / c, "", nc, exact ? 0.92 * nc : kNone,
           exact ? 1.08 * nc : kNone, std::string("[Prandtl 1920] ") + kSource)
      .holds_for("phi 0, weightless soil, a breadth of 20 cells",
                 exact && setup["breadth"] > 19.999 * setup.cell);
}

/// Presses the strip in at constant speed; the factor is read where the load no longer grows.
Report run_footing(const Setup& setup) {
  const double cell = setup.cell, q = setup["surcharge-pa"];
  // With neither cohesion nor surcharge the limit load would be zero, and the factor 0 / 0.
  if (!(q > 0) && !(setup.soil.cohesion > 0))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "lab footing --surcharge-pa", "0",
                           "above 0 for soil without cohesion",
                           "give --surcharge-pa or --cohesion-pa"});
  const Strip strip = strip_of(setup);
  Site site(setup, strip_soils(setup), strip_site(setup, strip));
  place_footing(site, strip, q);
  ChuteShape shape;
  shape.half = chute_half(cell), shape.gap = strip.gap,
  shape.top = (kLayerCells + 6) * cell + strip.settlement;
  shape.ahead = strip.ahead + strip.breadth / 2 + 3 * cell, shape.bottom = -strip.below - 3 * cell;
  // Faces of the stem lie half a plate outside the breadth's lines, the sole's face at the ground.
  const double inset = shape.half + setup["offset"] * cell;
  // A stem as wide as the sole: soil that rises beside the footing presses only on its flanks.
  ToolDriver driver(site, footing_chute(shape, strip.breadth - 2 * inset),
                    make_pose(0, chute_offset(cell), shape.half));
  // Slow against the speed of sound; the inertial force is small beside c.
  const double speed = setup["speed"], seconds = strip.settlement / speed;
  site.expect(seconds);
  driver.advance(strip.settlement, Vec3(0, 0, -speed));
  // Pressure refers to the nominal breadth, not to the narrowed shell.
  const double area = strip.breadth * strip.gap;
  const Trace& trace = driver.trace();
  // The whole curve goes into the file: it shows a limit that is not reached.
  Series travel{"settlement over breadth", "", {}}, pressure{"pressure", "Pa", {}};
  for (int i = 0; i < 20; ++i) {
    const double from = i * strip.settlement / 20, to = (i + 1) * strip.settlement / 20;
    travel.values.push_back(0.5 * (from + to) / strip.breadth);
    pressure.values.push_back(mean_force(trace, from, to).z() / area);
  }
  Report report;
  // At a plateau the last fifth is no more than the middle one.
  const double last = mean_force(trace, 0.8 * strip.settlement, strip.settlement).z() / area;
  judge(setup, last, report);
  const double middle =
      mean_force(trace, 0.4 * strip.settlement, 0.6 * strip.settlement).z() / area;
  report.note("pressure, last fifth over middle fifth", last / middle, "", "1: a plateau");
  report.series = {travel, pressure};
  report.note("particles through the shell",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  site.finish(report);
  return report;
}

/// Presses the plate in and fits p = k z^n to the curve, by least squares of the logarithms.
Report run_plate(const Setup& setup) {
  const double cell = setup.cell, b = setup["breadth"], l = setup["length"],
               deep = setup["sinkage"];
  const double x = whole_cells(l / 2 + 1.5 * b, cell), y = whole_cells(2 * b, cell),
               z = whole_cells(2 * b + deep, cell);
  const SiteBox bed{Vec3(-x, -y, -z), Vec3(x, y, 0)};
  SiteOptions options;
  options.size = 2 * (std::max(x, y) + 4 * cell);
  options.depth = z + 8 * cell;
  options.surface = pit(bed);
  Site site(setup, options);
  auto soil = site.fill(bed);
  site.rest(soil, 0.0);
  site.solver().insert(soil);
  scene::Shell shell = plate(l, b);
  ToolDriver driver(site, shell, make_pose(0.03 * cell, 0.07 * cell, shell.half_thickness));
  const double speed = setup["speed"];
  // The bed is five breadths wide and two deeper than the sinkage: its walls have no effect.
  site.expect(deep / speed);
  driver.advance(deep, Vec3(0, 0, -speed));
  Series depth{"sinkage", "m", {}}, pressure{"pressure", "Pa", {}};
  std::vector<double> log_z, log_p;
  for (int i = 0; i < 20; ++i) {
    const double from = i * deep / 20, to = (i + 1) * deep / 20;
    depth.values.push_back(0.5 * (from + to));
    pressure.values.push_back(mean_force(driver.trace(), from, to).z() / (b * l));
    // In the first tenth the plate finds its contact.
    if (i < 2 || !(pressure.values.back() > 0)) continue;
    log_z.push_back(std::log(depth.values.back())),
        log_p.push_back(std::log(pressure.values.back()));
  }
  Report report;
  if (log_z.size() > 2) {
    const Line line = fit_line(log_z, log_p);
    // For comparison with the soil's own n; neither is expected of the other.
    report.note("exponent n of p = k z^n", line.b, "", "fit over 10 .. 100 % of the sinkage");
    report.note("k of p = k z^n", std::exp(line.a) / 1000, "kPa/m^n");
  }
  const double law = terramechanics::plate_pressure(setup.soil, deep, b);
  report.add("pressure at full sinkage", pressure.values.back() / 1000, "kPa", law / 1000, kNone,
             kNone, "[Bekker 1969], with the soil's own parameters");
  report.note("particles through the plate",
              static_cast<double>(site.solver().stats().shell_crossings), "");
  report.series = {depth, pressure};
  site.finish(report);
  return report;
}

}  // namespace

Rig footing_rig() {
  Rig rig;
  rig.name = "footing";
  rig.summary = "strip footing on weightless soil: bearing capacity factors Nc and Nq";
  rig.drawing =
      "A smooth strip of `breadth` with an upright stem is pressed into level soil at `speed`, in "
      "plane strain between smooth plates. Without surcharge, gravity is off (`weightless` yes) "
      "and the factor is the pressure over c at the last fifth of `settlement`. With "
      "`surcharge-pa` a layer of two cells lies on the soil beside the footing. It has no "
      "strength and is a hundred times denser, and gravity is reduced until the layer has the "
      "weight of the surcharge, so that the soil's own weight is a hundredth of it per layer. The "
      "layer has inertia: runs that are faster or softer than the example measure that inertia, "
      "or end before the strength is mobilised.";
  rig.examples = {{"Nc of clay", "--phi-deg 0 --cohesion-pa 5000"},
                  {"Nq, with tolerances at phi 20 and 30",
                   "--cohesion-pa 0 --phi-deg 20 --surcharge-pa 2000 --young-pa 4e6 --settlement "
                   "0.08 --speed 0.02 --cell 0.1"}};
  rig.parameters = {
      {"breadth", 1, "m", "of the strip, 20 cells or more for the tolerances", above(0)},
      {"settlement", 0.12, "breadths", "at the end", above(0)},
      {"speed", 0.2, "m/s", "downwards", above(0)},
      {"beside", 2, "breadths", "of soil on either side", at_least(0)},
      {"below", 1.2, "breadths", "of soil", at_least(0)},
      {"offset", 0.4, "cells", "by which the shell is narrower at each edge", at_least(0)},
      {"surcharge-pa", 0, "Pa", "on the ground beside the footing", at_least(0)},
      yes_no("weightless", true, "gravity off when there is no surcharge", "full gravity")};
  rig.default_soil = cohesive(0, 5000);
  rig.default_cell = 0.05;
  rig.experiment = run_footing;
  return rig;
}

Rig plate_rig() {
  Rig rig;
  rig.name = "plate";
  rig.summary = "plate pressed into the ground: pressure against sinkage";
  rig.drawing =
      "A flat plate of `length` by `breadth` is pressed into level ground at `speed` to "
      "`sinkage`. The curve is fitted with p = k z^n. The expected value is Bekker's law with the "
      "soil's own parameters, which tyres use on resting ground; it is not a property of the "
      "particle law.";
  rig.parameters = {{"length", 0.6, "m", "of the plate", above(0)},
                    {"breadth", 0.3, "m", "of the plate", above(0)},
                    {"sinkage", 0.1, "m", "at the end", above(0)},
                    {"speed", 0.1, "m/s", "downwards", above(0)}};
  rig.default_soil = clean_sand(35);
  rig.default_cell = 0.05;
  rig.experiment = run_plate;
  return rig;
}

}  // namespace navvy::lab
