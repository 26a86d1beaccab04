// SPDX-License-Identifier: Apache-2.0
// Rigs `shear` and `triaxial`: one element of soil, in the middle of a small sample that the kernels themselves strain.
//
// The law by itself is tested without a grid (tests/soil/particles). Here the same strains come through transfers,
// contact and steps, as in any dig, and the stress is read from the particles in the middle, so that rims, lids and
// plates only have to strain the sample and are not what is measured. There is no gravity: the sample is the same
// everywhere.
#include <algorithm>
#include <cmath>
#include <functional>

#include "lab/rigs/rig_list.h"
#include "lab/shapes.h"
#include "lab/soils.h"
#include "lab/theory/earth_pressure.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Element and law]";

/// Mean stress of the particles in a box, positive in compression [Pa]; shear on the xz planes.
struct Stress {
  double xx = 0, yy = 0, zz = 0, xz = 0;
};

Stress stress_in(const Site& site, const Box& box) {
  Stress sum;
  double count = 0;
  for (const soil::Particle& p : site.solver().particles()) {
    if (!box.contains(site.position(p))) continue;
    const double pressure = site.pressure(p);
    sum.xx += pressure - static_cast<double>(p.s[0]), sum.yy += pressure - static_cast<double>(p.s[1]);
    sum.zz += pressure - static_cast<double>(p.s[2]), sum.xz -= static_cast<double>(p.s[5]);
    count += 1;
  }
  // No particle in the middle: not a stress of nothing.
  count = count > 0 ? count : kNone;
  return {sum.xx / count, sum.yy / count, sum.zz / count, sum.xz / count};
}

/// Particles under the pressure `p` on all sides, from the start.
std::vector<soil::Particle> pressed(const Site& site, const Box& box, double p) {
  auto out = site.fill(box);
  const double bulk = site.soil().young_modulus / (3 * (1 - 2 * site.soil().poisson));
  for (soil::Particle& grain : out) grain.j = static_cast<float>(1 - p / bulk);
  return out;
}

/// Site without gravity, its ground a pit of the sample's size whose floor and walls rest.
SiteOptions weightless(const Box& sample, double floor, double cell, double courant) {
  SiteOptions out;
  const double reach = std::max(sample.high.x(), sample.high.y());
  out.size = 2 * (reach + 8 * cell);
  out.depth = -floor + 8 * cell;
  out.gravity = Vec3::Zero();
  out.surface = pit(Box{Vec3(sample.low.x(), sample.low.y(), floor), sample.high});
  out.courant = courant;
  return out;
}

// Simple shear.

/// A layer on resting ground under a rough plate that is drawn along it and presses with `sigma-pa`.
Report run_shear(const Setup& setup) {
  const double cell = setup.cell, length = setup["length"] * cell, width = setup["width"] * cell,
               height = setup["height"] * cell, sigma = setup["sigma-pa"], speed = setup["speed"];
  const Box sample{Vec3(-length / 2, -width / 2, -height), Vec3(length / 2, width / 2, 0)};
  // Rough enough that the soil slips in itself, not along the plate.
  Setup rough = setup;
  rough.soil.tool_friction_angle = std::max(setup.soil.tool_friction_angle, radians(50));
  Site site(rough, weightless(sample, -height, cell, setup["courant"]));
  site.solver().insert(pressed(site, sample, sigma));
  scene::Shell lid = plate(length + 4 * cell, width + 4 * cell);
  // The soil lies behind the plate's front.
  lid.half_thickness = 0.25 * cell;
  ToolDriver driver(site, lid, make_pose(0, 0, lid.half_thickness));
  Tool& tool = site.tool(driver.tool());
  const double area = length * width;
  tool.only_sinks = true;
  tool.mass = setup["lid-mass"] * setup.soil.bank_density * area * height;
  tool.force_W = Vec3(0, 0, -sigma * area);
  const Box middle{Vec3(-length / 6, -width / 4, -0.75 * height), Vec3(length / 6, width / 4, -0.25 * height)};
  const double dt = site.step_limit(speed), way = setup["travel"] * height;
  // From rest over a tenth of the way: a plate that starts at once sends a wave through the layer.
  const double rise = std::min(0.1 * way, setup["ramp"]), seconds = (way + rise) / speed;
  const int steps = static_cast<int>(std::ceil(seconds / dt)), readings = 20;
  site.expect(steps * dt);
  Series strain{"shear strain", "", {}}, ratio{"tau over sigma", "", {}};
  double sum = 0;
  for (int i = 1; i <= steps; ++i) {
    tool.motion.v_WT.x() = speed * std::min(1.0, i * dt * speed / (2 * rise)), tool.motion.v_WT.y() = 0;
    driver.step(dt);
    if (i % std::max(1, steps / readings) != 0) continue;
    const Stress s = stress_in(site, middle);
    strain.values.push_back(driver.pose().translation().x() / height);
    ratio.values.push_back(s.xz / s.zz);
  }
  // The last half: sigma_x has grown to sigma_z by then, so that stress and strain rate have common axes.
  const auto half = ratio.values.size() / 2;
  for (std::size_t i = half; i < ratio.values.size(); ++i) sum += ratio.values[i];
  const Stress last = stress_in(site, middle);
  const double mean = std::abs(sum) / static_cast<double>(ratio.values.size() - half);
  const double expected = std::sin(setup.soil.friction_angle);
  Report report;
  report
      .add("tau over sigma", mean, "", expected, 0.99 * expected, 1.01 * expected,
           std::string("sin phi, zero dilatancy ") + kSource)
      .holds_for("soil without cohesion and dilatancy, strained by 0.1 or more, 0.005 .. 0.6 m/s",
                 !(setup.soil.cohesion > 0) && !(setup.soil.dilatancy_angle > 0) && setup["travel"] > 0.0999 &&
                     speed > 0.00499 && speed < 0.6001);
  report.note("tau over sigma / sin phi", mean / expected, "");
  report.note("normal stress", last.zz, "Pa");
  report.note("stress along the motion over normal stress", last.xx / last.zz, "", "1 where tau over sigma is sin phi");
  report.note("plate sank by", -1000 * (driver.pose().translation().z() - lid.half_thickness), "mm");
  report.series = {strain, ratio};
  site.finish(report);
  return report;
}

// Triaxial.

/// Six smooth plates that strain the sample at constant volume: the axis by `rate`, the sides by minus half of it.
struct Press {
  std::vector<int> tools;
  std::vector<Vec3> outward;  ///< by tool, its plate's direction

  Press(Site& site, double half, double thickness) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 n = sign * Vec3::Unit(axis);
        scene::Shell shell = plate(3 * half, 3 * half);
        shell.half_thickness = thickness;
        Pose X = Pose::Identity();
        // The plate's front looks along its z, at the sample.
        X.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), -n).toRotationMatrix();
        X.translation() = (half + thickness) * n;
        tools.push_back(site.add_tool(shell, X));
        outward.push_back(n);
      }
  }

  /// Plates move at the speed that their place has in the even strain.
  void strain(Site& site, double half, const Vec3& rate) const {
    for (std::size_t i = 0; i < tools.size(); ++i)
      site.tool(tools[i]).motion.v_WT = half * rate.cwiseProduct(outward[i]);
  }
};

/// Mobilised angle [rad] of the largest and the least of three stresses.
double mobilised(const Stress& s) {
  const double most = std::max({s.xx, s.yy, s.zz}), least = std::min({s.xx, s.yy, s.zz});
  return std::asin(std::clamp((most - least) / (most + least), -1.0, 1.0));
}

Report run_triaxial(const Setup& setup) {
  const double cell = setup.cell, half = 0.5 * setup["edge"] * cell, p = setup["pressure-pa"];
  const bool compression = setup.is("path", "compression");
  const Box sample{Vec3::Constant(-half), Vec3::Constant(half)};
  Setup smooth = setup;
  smooth.soil = without_tool_friction(setup.soil);
  // In the air: a pit twice as wide and as deep as the sample.
  Site site(smooth, weightless(Box{2 * sample.low, 2 * sample.high}, -half - 8 * cell, cell, setup["courant"]));
  auto soil = pressed(site, sample, p);
  const double axial = (compression ? -1 : 1) * setup["rate"];
  const Vec3 rate(-axial / 2, -axial / 2, axial);
  // The sample moves evenly from the start, plates and all: no wave runs through it.
  for (soil::Particle& grain : soil)
    for (int a = 0; a < 3; ++a) {
      grain.v[a] = static_cast<float>(rate[a] * site.position(grain)[a]);
      grain.c[4 * a] = static_cast<float>(rate[a]);
    }
  site.solver().insert(soil);
  const Press press(site, half, 0.25 * cell);
  press.strain(site, half, rate);
  const double seconds = setup["strain"] / setup["rate"];
  site.expect(seconds);
  const Box middle{Vec3::Constant(-half / 2), Vec3::Constant(half / 2)};
  Series strain{"axial strain", "", {}}, angle{"mobilised angle", "deg", {}};
  constexpr int kReadings = 20;
  for (int i = 1; i <= kReadings; ++i) {
    site.run(seconds / kReadings);
    strain.values.push_back(setup["strain"] * i / kReadings);
    angle.values.push_back(degrees(mobilised(stress_in(site, middle))));
  }
  // The last quarter: elastic strain is long done, the cube is still nearly one.
  double mean = 0;
  for (int i = kReadings - 5; i < kReadings; ++i) mean += angle.values[static_cast<std::size_t>(i)] / 5;
  const Stress last = stress_in(site, middle);
  const double expected = degrees(matsuoka_nakai_triaxial(setup.soil.friction_angle));
  Report report;
  report
      .add("mobilised friction angle", mean, "deg", expected, expected - 0.2, expected + 0.2,
           std::string("[Matsuoka 1974] matched in plane strain ") + kSource)
      .holds_for("soil without cohesion and dilatancy, strained by 0.04 or more",
                 !(setup.soil.cohesion > 0) && !(setup.soil.dilatancy_angle > 0) && setup["strain"] > 0.0399);
  report.note("plane-strain angle", degrees(setup.soil.friction_angle), "deg");
  report.note("axial stress", last.zz, "Pa");
  report.note("stress on the sides", 0.5 * (last.xx + last.yy), "Pa");
  report.note("difference of the sides", std::abs(last.xx - last.yy) / (0.5 * (last.xx + last.yy)), "");
  report.series = {strain, angle};
  site.finish(report);
  return report;
}

}  // namespace

Rig shear_rig() {
  Rig rig;
  rig.name = "shear";
  rig.summary = "simple shear of a layer: tau over sigma in its middle is sin phi, at any speed";
  rig.drawing =
      "A layer of `length` x `width` x `height` cells lies without gravity on resting ground in a pit of its size, "
      "under "
      "a rough plate that presses with `sigma-pa`, is free to sink and is drawn along x at `speed` by `travel` "
      "heights. "
      "tau over sigma is the mean stress of the particles in the layer's middle over the second half of the way; what "
      "the plate itself feels is not used.";
  rig.examples = {{"As slow as a machine ever moves", "--speed 0.005"}};
  rig.parameters = {{"length", 24, "cells", "of the layer", above(0)},
                    {"width", 8, "cells", "of the layer", above(0)},
                    {"height", 4, "cells", "of the layer", above(0)},
                    {"sigma-pa", 3000, "Pa", "under the plate", above(0)},
                    {"speed", 0.05, "m/s", "of the plate", above(0)},
                    {"travel", 0.12, "heights", "of the plate", above(0)},
                    {"ramp", 0.015, "m", "of travel over which it comes up to speed, a tenth at most", above(0)},
                    {"lid-mass", 0.25, "", "of the plate, over that of the layer", above(0)},
                    {"courant", 0.5, "", "the step, as a share of the cell over the speed of sound", between(0.01, 1)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_shear;
  return rig;
}

Rig triaxial_rig() {
  Rig rig;
  rig.name = "triaxial";
  rig.summary = "triaxial compression and extension: the mobilised friction angle";
  rig.drawing =
      "A cube of `edge` cells under `pressure-pa` on all sides, without gravity, between six smooth plates: its axis "
      "is "
      "strained by `strain` at `rate`, its sides by half of it the other way, so that its volume stays. The angle is "
      "that of the largest and least mean stress of the particles in the middle, over the last quarter. Sand stands 2 "
      "to 4 degrees below its plane-strain angle here, in compression as in extension.";
  rig.examples = {{"Extension", "--path extension"}};
  rig.parameters = {choice("path", "compression", "",
                           {{"compression", 0, "the axis is pressed, the sides give way"},
                            {"extension", 1, "the axis gives way, the sides are pressed"}}),
                    {"edge", 8, "cells", "of the cube", above(0)},
                    {"pressure-pa", 10000, "Pa", "at the start", above(0)},
                    {"rate", 0.1, "1/s", "of the axial strain", above(0)},
                    {"strain", 0.06, "", "of the axis, in all", above(0)},
                    {"courant", 0.5, "", "the step, as a share of the cell over the speed of sound", between(0.01, 1)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_triaxial;
  return rig;
}

}  // namespace navvy::lab
