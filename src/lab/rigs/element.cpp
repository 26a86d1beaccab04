// SPDX-License-Identifier: Apache-2.0
// Rigs `shear` and `triaxial`: one element of soil, in the middle of a small sample that the
// kernels themselves strain.
//
// The law by itself is tested without a grid (tests/soil/particles). Here the same strains come
// through transfers, contact and steps, as in any dig. Stress is read from the particles in the
// middle, so that rims, lids and plates only strain the sample and are not measured. There is no
// gravity: the sample is uniform.
#include <algorithm>
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"
#include "lab/theory/earth_pressure.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Element and law]";

/// Mean stress of the particles in a box, positive in compression [Pa].
struct Stress {
  double xx = 0, yy = 0, zz = 0;
};

Stress stress_in(const Site& site, const SiteBox& box) {
  Stress sum;
  double count = 0;
  for (const soil::Particle& p : site.solver().particles()) {
    if (!box.contains(site.position(p))) continue;
    const double pressure = site.pressure(p);
    sum.xx += pressure - static_cast<double>(p.s[0]),
        sum.yy += pressure - static_cast<double>(p.s[1]);
    sum.zz += pressure - static_cast<double>(p.s[2]);
    count += 1;
  }
  // No particle in the middle: not a zero stress.
  count = count > 0 ? count : kNone;
  return {sum.xx / count, sum.yy / count, sum.zz / count};
}

/// Returns particles under the pressure `p` on all sides, from the start.
std::vector<soil::Particle> pressed(const Site& site, const SiteBox& box, double p) {
  auto out = site.fill(box);
  const double bulk = site.soil().young_modulus / (3 * (1 - 2 * site.soil().poisson));
  for (soil::Particle& grain : out) grain.j = static_cast<float>(1 - p / bulk);
  return out;
}

/// Returns a site without gravity, its ground a pit of the sample's size whose floor and walls
/// rest.
SiteOptions weightless(const SiteBox& sample, double floor, double cell) {
  SiteOptions out;
  const double reach = std::max(sample.high.x(), sample.high.y());
  out.size = 2 * (reach + 8 * cell);
  out.depth = -floor + 8 * cell;
  out.gravity = Vec3::Zero();
  out.surface = pit(SiteBox{Vec3(sample.low.x(), sample.low.y(), floor), sample.high});
  return out;
}

/// Six smooth plates around the sample.
struct Press {
  std::vector<int> tools;
  /// Direction of a tool's plate, by tool.
  std::vector<Vec3> outward;

  Press(Site& site, double half, double thickness) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 n = sign * Vec3::Unit(axis);
        scene::Shell shell = plate(3 * half, 3 * half);
        shell.half_thickness = thickness;
        Pose X = Pose::Identity();
        // The plate's front faces the sample along its z.
        X.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), -n).toRotationMatrix();
        X.translation() = (half + thickness) * n;
        tools.push_back(site.add_tool(shell, X));
        outward.push_back(n);
      }
  }

  /// Plates move at the speed of their place in the uniform strain.
  void strain(Site& site, double half, const Vec3& rate) const {
    for (std::size_t i = 0; i < tools.size(); ++i)
      site.tool(tools[i]).motion.v_WT = half * rate.cwiseProduct(outward[i]);
  }
};

/// Returns the sine of the angle that the largest and the least of three stresses mobilise: tau /
/// sigma of the shearing plane.
double mobilised(const Stress& s) {
  const double most = std::max({s.xx, s.yy, s.zz}), least = std::min({s.xx, s.yy, s.zz});
  return std::clamp((most - least) / (most + least), -1.0, 1.0);
}

/// Results of one straining.
struct Strained {
  /// Mobilised, mean of the last quarter.
  double sine = 0;
  /// At the end.
  Stress last;
};

/// Strains a cube uniformly by `rate` [1/s], without change of volume, until the largest strain is
/// `strain`.
Strained strain_cube(const Setup& setup, const Vec3& rate, Report& report) {
  const double cell = setup.cell, half = 0.5 * setup["edge"] * cell, p = setup["pressure-pa"];
  const SiteBox sample{Vec3::Constant(-half), Vec3::Constant(half)};
  Setup smooth = setup;
  smooth.soil = without_tool_friction(setup.soil);
  // In the air: a pit twice as wide and as deep as the sample.
  Site site(smooth, weightless(SiteBox{2 * sample.low, 2 * sample.high}, -half - 8 * cell, cell));
  auto soil = pressed(site, sample, p);
  // The sample and its plates move uniformly from the start: no wave runs through it.
  for (soil::Particle& grain : soil)
    for (int a = 0; a < 3; ++a) {
      grain.v[a] = static_cast<float>(rate[a] * site.position(grain)[a]);
      grain.c[4 * a] = static_cast<float>(rate[a]);
    }
  site.solver().insert(soil);
  const Press press(site, half, 0.25 * cell);
  press.strain(site, half, rate);
  const double fastest = rate.cwiseAbs().maxCoeff(), seconds = setup["strain"] / fastest;
  site.expect(seconds);
  const SiteBox middle{Vec3::Constant(-half / 2), Vec3::Constant(half / 2)};
  Series strain{"largest strain", "", {}}, sine{"mobilised sin phi", "", {}};
  constexpr int kReadings = 20;
  Strained out;
  for (int i = 1; i <= kReadings; ++i) {
    site.run(seconds / kReadings);
    strain.values.push_back(setup["strain"] * i / kReadings);
    out.last = stress_in(site, middle);
    sine.values.push_back(mobilised(out.last));
    // The last quarter: elastic strain is long done, the cube is still nearly one.
    if (i > kReadings - 5) out.sine += sine.values.back() / 5;
  }
  report.series = {strain, sine};
  site.finish(report);
  return out;
}

/// Reports the mobilised `angle` [rad] against the one that was given for `test`, if it was.
void report_given(const Setup& setup, scene::FrictionTest test, double angle, bool judged,
                  Report& report) {
  if (setup.soil.friction_test != test) return;
  const double given = degrees(setup.soil.tested_friction_angle);
  report
      .add("angle of the test that was given", degrees(angle), "deg", given, given - 1, given + 1,
           "the given angle, converted to plane strain [docs/soil.md, friction angles]")
      .holds_for("soil without cohesion and dilatancy, strained by 0.04 or more", judged);
}

/// Returns true if the theory of both rigs applies to this setup.
bool plain(const Setup& setup) {
  return !(setup.soil.cohesion > 0) && !(setup.soil.dilatancy_angle > 0) &&
         setup["strain"] > 0.0399;
}

Report run_shear(const Setup& setup) {
  // Compression along x, extension along z, y fixed: the planes between them shear.
  const double speed = setup["speed"], rate = speed / (0.5 * setup["edge"] * setup.cell);
  Report report;
  const Strained got = strain_cube(setup, Vec3(-rate, 0, rate), report);
  const double expected = std::sin(setup.soil.friction_angle);
  // Below 0.1 /s soil has up to its static share more [docs/soil.md, static friction]; planes shear
  // by 2 rate.
  const double share = 2 * rate < 0.1 ? setup.soil.static_friction_share : 0;
  report
      .add("tau over sigma", got.sine, "", expected, 0.99 * expected, (1.01 + share) * expected,
           std::string("sin phi, zero dilatancy, and the static share below 0.1 /s ") + kSource)
      .holds_for("soil without cohesion and dilatancy, strained by 0.04 or more, 0.005 .. 0.6 m/s",
                 plain(setup) && speed > 0.00499 && speed < 0.6001);
  report_given(setup, scene::FrictionTest::kDirectShear, std::atan(got.sine), plain(setup), report);
  report.note("tau over sigma / sin phi", got.sine / expected, "");
  report.note("angle of a direct shear test", degrees(std::atan(got.sine)), "deg",
              "atan(tau / sigma)");
  report.note("middle stress over the mean of the others",
              2 * got.last.yy / (got.last.xx + got.last.zz), "", "1 without dilatancy");
  report.note("normal stress", 0.5 * (got.last.xx + got.last.zz), "Pa");
  return report;
}

Report run_triaxial(const Setup& setup) {
  const double axial = (setup.is("path", "compression") ? -1 : 1) * setup["rate"];
  Report report;
  const Strained got = strain_cube(setup, Vec3(-axial / 2, -axial / 2, axial), report);
  const double expected = degrees(matsuoka_nakai_triaxial(setup.soil.friction_angle));
  report
      .add("mobilised friction angle", degrees(std::asin(got.sine)), "deg", expected,
           expected - 0.2, expected + 0.2,
           std::string("[Matsuoka 1974] matched in plane strain ") + kSource)
      .holds_for("soil without cohesion and dilatancy, strained by 0.04 or more", plain(setup));
  report_given(setup, scene::FrictionTest::kTriaxial, std::asin(got.sine), plain(setup), report);
  report.note("plane-strain angle", degrees(setup.soil.friction_angle), "deg");
  report.note("axial stress", got.last.zz, "Pa");
  report.note("stress on the sides", 0.5 * (got.last.xx + got.last.yy), "Pa");
  report.note("difference of the sides",
              2 * std::abs(got.last.xx - got.last.yy) / (got.last.xx + got.last.yy), "");
  return report;
}

}  // namespace

Rig shear_rig() {
  Rig rig;
  rig.name = "shear";
  rig.summary =
      "shear of a sample in plane strain: tau over sigma in its middle is sin phi, at any speed";
  rig.drawing =
      "A cube of `edge` cells under `pressure-pa` on all sides, without gravity, lies between six "
      "smooth plates. One pair closes at `speed` each, one opens at the same speed, and the third "
      "stays, until the strain is `strain`. tau over sigma is that of the shearing planes, (s1 - "
      "s3) / (s1 + s3) of the mean stress of the particles in the middle, over the last quarter. "
      "Forces on plates are not used.";
  rig.examples = {{"As slow as a machine ever moves", "--speed 0.005"},
                  {"A sand of 35 deg in direct shear", "--direct-shear-deg 35"}};
  rig.parameters = {{"edge", 8, "cells", "of the cube", above(0)},
                    {"pressure-pa", 10000, "Pa", "at the start", above(0)},
                    {"speed", 0.05, "m/s", "of the plates", above(0)},
                    {"strain", 0.06, "", "in all", above(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_shear;
  return rig;
}

Rig triaxial_rig() {
  Rig rig;
  rig.name = "triaxial";
  rig.summary = "triaxial compression and extension: the mobilised friction angle";
  rig.drawing =
      "A cube of `edge` cells under `pressure-pa` on all sides, without gravity, lies between six "
      "smooth plates. Its axis is strained by `strain` at `rate`, its sides by half of it in the "
      "opposite direction, so that its volume is constant. The angle is that of the largest and "
      "least mean stress of the particles in the middle, over the last quarter. Sand has 2 to 4 "
      "degrees less than its plane-strain angle here, in compression and in extension.";
  rig.examples = {{"Extension", "--path extension"},
                  {"A sand of 35 deg in triaxial compression", "--triaxial-deg 35"}};
  rig.parameters = {choice("path", "compression", "",
                           {{"compression", 0, "the axis is compressed, the sides extend"},
                            {"extension", 1, "the axis extends, the sides are compressed"}}),
                    {"edge", 12, "cells", "of the cube", above(0)},
                    {"pressure-pa", 10000, "Pa", "at the start", above(0)},
                    {"rate", 0.1, "1/s", "of the axial strain", above(0)},
                    {"strain", 0.06, "", "of the axis, in all", above(0)}};
  rig.default_soil = clean_sand(35);
  rig.experiment = run_triaxial;
  return rig;
}

}  // namespace navvy::lab
