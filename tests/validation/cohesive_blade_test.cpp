// SPDX-License-Identifier: Apache-2.0
// A blade in cohesive soil: the full strength must act at any cohesion, speed and cell, and
// continue to act after the first travel. The soil does not soften and is 200 times as stiff as its
// cohesion.
#include <algorithm>
#include <string>

#include "validation/rig_case.h"
#include "values.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "[docs/validation.md, Blades in cohesive soil]";

struct Push {
  double cohesion;      ///< [Pa]
  double delta = 0;     ///< on the blade [deg]
  double speed = 0.15;  ///< [m/s]
  double cell = 0.1;    ///< [m]
  double adhesion = 0;  ///< [Pa]
};

lab::Report push(const Push& of, double from, double travel) {
  lab::Report report = lab::run_rig(
      "blade", {{"speed", of.speed}, {"from", from}, {"travel", travel}, {"tolerance-percent", 0}},
      [&](lab::Setup& s) {
        s.cell = of.cell;
        s.soil.bank_density = 1540, s.soil.friction_angle = radians(30);
        s.soil.cohesion = s.soil.residual_cohesion = of.cohesion;
        s.soil.young_modulus = std::max(1e6, 200 * of.cohesion);
        s.soil.tool_friction_angle = radians(of.delta), s.soil.adhesion = of.adhesion;
      });
  EXPECT_EQ(report.ledger_error, 0);
  return report;
}

/// Returns the largest low-passed force over the expected one, up to a travel of half the depth:
/// later a pile adds its weight.
double peak_of(const Push& of) { return lab::measured(push(of, 0.1, 0.15), "peak over expected"); }
/// Returns the mean over 0.20 .. 0.25 m of travel over the expected force.
double late_of(const Push& of) {
  return lab::measured(push(of, 0.2, 0.25), "horizontal over expected");
}

std::string kilopascals(double cohesion) { return lab::short_text(cohesion / 1000) + " kPa"; }

TEST(CohesiveBlade, MeetsTheFullStrengthAtAnyCohesion) {
  double least = 1e9, most = 0, sum = 0;
  for (const double cohesion : {6e3, 20e3, 50e3, 150e3}) {
    const double peak = peak_of({cohesion});
    expect_between("smooth blade, peak / Reece, c " + kilopascals(cohesion), peak, 0.85, 1.10,
                   std::string("[Reece 1964] ") + kSource, 1);
    // Yielding soil must not open and lose its cohesion as it rebounds.
    expect_between("smooth blade, force after 0.2 m / peak, c " + kilopascals(cohesion),
                   late_of({cohesion}) / peak, 0.8, kNoLimit, kSource);
    least = std::min(least, peak), most = std::max(most, peak), sum += peak;
  }
  expect_between("smooth blade, spread of the four over their mean", (most - least) / (sum / 4),
                 -kNoLimit, 0.12, kSource, 0);
}

TEST(CohesiveBlade, MatchesSlipLinesWithToolFriction) {
  for (const double cohesion : {6e3, 20e3, 50e3})
    expect_between("delta 20 deg, peak / slip lines, c " + kilopascals(cohesion),
                   peak_of({cohesion, 20}), 0.80, 1.05,
                   std::string("[Sokolovskii 1965] ") + kSource, 1);
}

TEST(CohesiveBlade, ForceIncludesAdhesion) {
  expect_between("adhesion 10 kPa, c 20 kPa, peak / slip lines",
                 peak_of({20e3, 0, 0.15, 0.1, 10e3}), 0.85, 1.10,
                 std::string("[Sokolovskii 1965] ") + kSource, 1);
}

TEST(CohesiveBlade, ForceDoesNotDependOnSpeedOrCell) {
  const double slow = peak_of({50e3, 0, 0.05}), fast = peak_of({50e3, 0, 0.5});
  expect_between("peak at 0.05 m/s / peak at 0.5 m/s, c 50 kPa", slow / fast, 0.9, kNoLimit,
                 kSource, 1);
  const double whole = peak_of({20e3}), half = peak_of({20e3, 0, 0.15, 0.05});
  expect_between("peak at half the cell / peak, c 20 kPa", half / whole, 0.95, 1.05, kSource, 1);
}

}  // namespace
}  // namespace navvy::validation
