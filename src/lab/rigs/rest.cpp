// SPDX-License-Identifier: Apache-2.0
// Rig `rest`: level ground under its own weight.
//
// This is the simplest state of soil and the start of everything else: if the ground does not carry
// the weight above, no force on a tool can be right. Stress is read from the particles, as the law
// stores it. A reaction at the floor would be right for any distribution inside. The vertical
// stress is right within one percent, with ringing of a percent or two. sigma_x is K0 sigma_z only
// while the soil stays elastic; loose sand of low friction yields at rest and correctly shows less.
#include <algorithm>
#include <cmath>

#include "lab/lab_site.h"
#include "lab/rigs/rig_list.h"
#include "lab/soils.h"

namespace navvy::lab {
namespace {

const char* const kSource = "[docs/validation.md, Rest and stress]";

/// Sums over the particles of the middle third, one cell clear of the pit's floor and of the free
/// surface. The walls carry some of the weight beside them, hence only the middle.
struct StressSums {
  // Fit through the origin, sigma_z = slope x weight above: slope = sum(w s) / sum(w w). A free
  // intercept would hide a surface that carries load.
  double zz = 0, zs = 0, error = 0, ratio = 0, count = 0;

  void add(const Site& site, double half, double depth) {
    const double weight_of = site.soil().bank_density * site.world().gravity.z();
    for (const soil::Particle& p : site.solver().particles()) {
      const Vec3 at = site.position(p);
      if (std::max(std::abs(at.x()), std::abs(at.y())) > half / 3) continue;
      // Nodes of the cells at floor and surface mix soil with resting ground or air.
      if (at.z() < site.cell() - depth || at.z() > -site.cell()) continue;
      const double pressure = site.pressure(p), weight = weight_of * at.z();
      // s is the deviator; stress is positive in tension, the pressure in compression.
      const double sz = static_cast<double>(p.s[2]) - pressure,
                   sx = static_cast<double>(p.s[0]) - pressure;
      zz += weight * weight;
      zs -= weight * sz;
      error += (sz + weight) * (sz + weight);
      ratio += sx / sz;
      count += 1;
    }
  }
};

/// Writes every particle of the middle third, floor and surface included: a plot shows what the fit
/// leaves out.
void write_profile(const Site& site, double half, Report& report) {
  Series height{"z", "m", {}}, vertical{"sigma_z", "Pa", {}}, horizontal{"sigma_x", "Pa", {}};
  for (const soil::Particle& p : site.solver().particles()) {
    const Vec3 at = site.position(p);
    if (std::max(std::abs(at.x()), std::abs(at.y())) > half / 3) continue;
    const double pressure = site.pressure(p);
    height.values.push_back(at.z());
    vertical.values.push_back(static_cast<double>(p.s[2]) - pressure);
    horizontal.values.push_back(static_cast<double>(p.s[0]) - pressure);
  }
  report.series = {height, vertical, horizontal};
}

/// Fills the pit, waits, and averages the second half of the time.
Report run(const Setup& setup) {
  const double depth = setup["depth"], half = setup["width"] / 2, seconds = setup["time"];
  const SiteBox bed{Vec3(-half, -half, -depth), Vec3(half, half, 0)};
  SiteOptions options;
  options.surface = pit(bed);
  // A metre of resting ground under the pit: bedrock has no effect.
  options.depth = depth + 1;
  Site site(setup, options);
  site.expect(seconds);
  std::vector<soil::Particle> start = site.fill(bed);
  if (setup.is("stressed", "yes")) site.rest(start, 0.0);
  site.solver().insert(start);
  // Sound waves of the start decay in the first half; the second is sampled, as sand at rest rings.
  site.run(seconds / 2);
  StressSums sums;
  const int samples = 12;
  for (int i = 0; i < samples; ++i) {
    site.run(seconds / 2 / samples);
    sums.add(site, half, depth);
  }
  // Particles keep their order while none comes or goes, so index i is the same particle.
  double farthest = 0;
  const std::vector<soil::Particle> end = site.solver().particles();
  for (std::size_t i = 0; i < end.size(); ++i)
    farthest = std::max(farthest, (site.position(end[i]) - site.position(start[i])).norm());

  Report report;
  // Uniaxial strain of an elastic body; holds while the soil does not yield, see the description.
  const double k0 = setup.soil.poisson / (1 - setup.soil.poisson);
  report.add("sigma_z over rho g z", sums.zs / sums.zz, "", 1, 0.99, 1.01, kSource);
  report.add("rms of sigma_z", 100 * std::sqrt(sums.error / sums.zz), "%", 0, 0, 4,
             std::string("an SPH soil's scatter ") + kSource);
  // The plane-strain yield surface, sqrt(J2) = p sin phi, under the stress at rest.
  const double yields = std::asin(std::min(1.0, std::sqrt(3.0) * (1 - k0) / (1 + 2 * k0)));
  const bool bears = setup.is("stressed", "yes") &&
                     (setup.soil.friction_angle > yields || setup.soil.cohesion > 0);
  const std::string range = "soil that carries K0 stress (phi above " +
                            short_text(degrees(yields)) + ", or cohesion), stressed at the start";
  report
      .add("sigma_x over sigma_z", sums.ratio / sums.count, "", k0, 0.97 * k0, 1.03 * k0,
           std::string("nu / (1 - nu), elastic rest ") + kSource)
      .holds_for(range, bears);
  report.add("farthest motion", 1000 * farthest, "mm", 0, 0, 1, kSource).holds_for(range, bears);
  write_profile(site, half, report);
  site.finish(report);
  return report;
}

}  // namespace

Rig rest_rig() {
  Rig rig;
  rig.name = "rest";
  rig.summary =
      "level ground at rest: vertical and horizontal stress compared with the weight above";
  rig.drawing =
      "A square pit, `width` wide and `depth` deep, lies in resting ground that holds its walls "
      "and floor. Particles fill it up to the surface. They start with the stress of level ground "
      "at rest (`stressed` yes), or without stress and settle (no). Over the second half of "
      "`time` the fit sigma_z = slope x rho g z is made for the middle third, in twelve samples, "
      "as sand at rest rings by a percent or two. Soil yields in plane strain under K0 = nu / (1 "
      "- nu) if phi is below about 32 degrees (nu 0.3); sigma_x is then not K0 sigma_z.";
  rig.parameters = {
      {"width", 2.8, "m", "edge of the pit", above(0)},
      {"depth", 0.8, "m", "depth of the pit", above(0)},
      {"time", 1.0, "s", "simulated time", above(0)},
      yes_no("stressed", true, "particles start with the stress of rest", "without stress")};
  rig.default_soil = clean_sand(35);
  rig.experiment = run;
  return rig;
}

}  // namespace navvy::lab
