// SPDX-License-Identifier: Apache-2.0
// Forces at several speeds and two steps each: a result that depends on either is not meaningful. A
// deviation fails unless it is in tolerances/known_deviations.md.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "validation/courant.h"
#include "validation/rig_case.h"
#include "values.h"

namespace navvy::validation {
namespace {

const char* const kSource = "[Rankine 1857] [docs/validation.md, Blades and earth pressure]";
const char* const kStep = "the step [docs/validation.md, speed and step]";

double blade(double cell, double speed, double courant) {
  const lab::Report report =
      lab::run_rig("blade", {{"speed", speed}, {"courant", courant}, {"tolerance-percent", 0}},
                   [&](lab::Setup& s) { s.cell = cell; });
  EXPECT_EQ(report.ledger_error, 0);
  return lab::measured(report, "horizontal over expected");
}

/// (largest - smallest) / mean.
double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const double value : values) sum += value;
  return (*high - *low) * static_cast<double>(values.size()) / sum;
}

TEST(ToolSpread, IsSmallForASmoothBladeOverSpeedsAndSteps) {
  std::vector<double> whole;
  double mean = 0, worst = 0;
  for (const double speed : {0.05, 0.15, 0.3}) {
    const double force = blade(0.05, speed, kUsualCourant);
    whole.push_back(force);
    mean += force / 3;
    worst = std::max(worst, std::abs(blade(0.05, speed, kHalfCourant) / force - 1));
  }
  expect_between("smooth blade, cells of 0.05 m, 0.05 .. 0.3 m/s: spread / mean", spread(whole), 0,
                 0.05, kSource);
  expect_between("smooth blade, cells of 0.05 m: mean force / Rankine", mean, 0.93, 1.07, kSource);
  expect_between("smooth blade, cells of 0.05 m: largest change at half the step", worst, 0, 0.01,
                 kStep);
}

// The curve of navvy::run::force_share, which `navvy check` warns by; depth 0.3 m.
TEST(CellsPerDepth, SetTheShareOfASmoothBladesForce) {
  for (const double cells : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0})
    print_value(
        "smooth blade, 0.15 m/s, " + lab::short_text(cells) + " cells per depth: force / Rankine",
        blade(0.3 / cells, 0.15, kUsualCourant), "1, no tolerance",
        "[Rankine 1857] [docs/validation.md, Cells per depth of cut]");
}

// Four times slower than the slowest of the others: contact does not depend on time.
TEST(ToolSpread, IsSmallForACreepingBlade) {
  const double creeping = blade(0.05, 0.0125, kUsualCourant);
  expect_between("smooth blade, cells of 0.05 m, force at 0.0125 m/s / at 0.05 m/s",
                 creeping / blade(0.05, 0.05, kUsualCourant), 0.95, 1.05, kSource);
  // Three cells deep: the limit of so few cells.
  print_value("smooth blade, cells of 0.1 m, force at 0.0125 m/s / at 0.05 m/s",
              blade(0.1, 0.0125, kUsualCourant) / blade(0.1, 0.05, kUsualCourant), "no tolerance",
              kSource);
}

TEST(ToolSpread, IsSmallForASmoothBladeInCoarseCells) {
  std::vector<double> whole;
  double worst = 0;
  for (const double speed : {0.05, 0.15, 0.3}) {
    whole.push_back(blade(0.1, speed, kUsualCourant));
    worst = std::max(worst, std::abs(blade(0.1, speed, kHalfCourant) / whole.back() - 1));
  }
  expect_between("smooth blade, cells of 0.1 m, 0.05 .. 0.3 m/s: spread / mean", spread(whole), 0,
                 0.13, kSource);
  expect_between("smooth blade, cells of 0.1 m: largest change at half the step", worst, 0, 0.01,
                 kStep);
  // Soil that a fast blade sets in motion adds rho v^2 d w to Rankine's 2606 N: 1600 kg/m3, 0.3 m,
  // 1 m.
  const double inertia = 1600 * 0.6 * 0.6 * 0.3 / 2606.4;
  expect_between("smooth blade, cells of 0.1 m, 0.6 m/s: force less rho v^2 d w / Rankine",
                 blade(0.1, 0.6, kUsualCourant) - inertia, 0.95, 1.05, kSource);
}

/// A force relative to its formula, and its bounds where tool friction leaves two.
struct Judged {
  double force = 0, expected = 0, low = 0, high = 0;
};

Judged judged(const lab::Report& report, const std::string& name) {
  EXPECT_EQ(report.ledger_error, 0);
  const lab::Quantity* q = report.find(name);
  EXPECT_NE(q, nullptr);
  return {q->measured, q->expected, q->low, q->high};
}

/// A wall of 1 m that moves into the soil by a fifth of its height [N/m].
Judged wall(double cell, double speed, double delta_degrees) {
  return judged(lab::run_rig("wall", {{"speed", speed}},
                             [&](lab::Setup& s) {
                               s.cell = cell;
                               s.soil.tool_friction_angle = radians(delta_degrees);
                             }),
                "passive force");
}

/// A rough blade in soil stiff enough to develop its wedge within 0.08 m of travel [N].
Judged rough_blade(double cell, double speed) {
  return judged(lab::run_rig("blade", {{"speed", speed}, {"from", 0.08}, {"travel", 0.12}},
                             [&](lab::Setup& s) {
                               s.cell = cell;
                               s.soil.young_modulus = 4e6;
                               s.soil.tool_friction_angle = radians(20);
                             }),
                "horizontal force");
}

/// Compares the forces at all speeds with each other, and their mean with its bounds.
void expect_one_force(const std::string& name, const std::vector<Judged>& runs, double most_spread,
                      double low, double high) {
  std::vector<double> forces;
  double mean = 0;
  for (const Judged& run : runs)
    forces.push_back(run.force), mean += run.force / static_cast<double>(runs.size());
  expect_between(name + ": spread over speeds / mean", spread(forces), 0, most_spread, kSource);
  expect_between(name + ": mean force / expected", mean / runs[0].expected, low / runs[0].expected,
                 high / runs[0].expected, kSource, 1);
}

TEST(ToolSpread, IsSmallForASmoothWallOverSpeeds) {
  for (const double cell : {0.1, 0.05}) {
    const std::vector<Judged> runs = {wall(cell, 0.05, 0), wall(cell, 0.2, 0)};
    expect_one_force("smooth wall, cells of " + lab::short_text(cell) + " m, 0.05 and 0.2 m/s",
                     runs, 0.04, 0.93 * runs[0].expected, 1.07 * runs[0].expected);
  }
}

TEST(ToolSpread, IsSmallForARoughWallOverSpeeds) {
  for (const double cell : {0.1, 0.05}) {
    const std::vector<Judged> runs = {wall(cell, 0.05, 20), wall(cell, 0.2, 20)};
    expect_one_force(
        "wall, delta 20 deg, cells of " + lab::short_text(cell) + " m, 0.05 and 0.2 m/s", runs,
        0.04, runs[0].low, runs[0].high);
  }
}

TEST(ToolSpread, IsSmallForARoughBladeOverSpeeds) {
  for (const double cell : {0.1, 0.05}) {
    const std::vector<Judged> runs = {rough_blade(cell, 0.05), rough_blade(cell, 0.15),
                                      rough_blade(cell, 0.3)};
    expect_one_force(
        "blade, delta 20 deg, cells of " + lab::short_text(cell) + " m, 0.05 .. 0.3 m/s", runs,
        cell > 0.07 ? 0.13 : 0.05, runs[0].low, runs[0].high);
  }
}

// Eight depths of the cutting edge within a cell: the effect of the grid on the end of a blade.
TEST(ToolSpread, IsSmallForASmoothBladeOverDepthsWithinACell) {
  std::vector<double> forces;
  double mean = 0, squares = 0;
  for (int i = 0; i < 8; ++i) {
    const lab::Report report = lab::run_rig(
        "blade", {{"speed", 0.15}, {"depth", 0.3 + 0.0125 * i}, {"tolerance-percent", 0}},
        [](lab::Setup& s) { s.cell = 0.1; });
    forces.push_back(lab::measured(report, "horizontal over expected"));
    mean += forces.back() / 8;
  }
  for (const double force : forces) squares += (force - mean) * (force - mean) / 7;
  expect_between("smooth blade, eight depths within a cell of 0.1 m: standard deviation / mean",
                 std::sqrt(squares) / mean, 0, 0.04, kSource);
}

TEST(ToolSpread, IsSmallForARakedBladeOverSteps) {
  const auto force = [](double courant) {
    const lab::Report report = lab::run_rig("blade",
                                            {{"width", 0.33},
                                             {"rake-deg", 60},
                                             {"depth", 0.10},
                                             {"length", 0.20},
                                             {"speed", 0.3},
                                             {"from", 0.1},
                                             {"travel", 0.3},
                                             {"ahead", 4},
                                             {"courant", courant},
                                             {"tolerance-percent", 0}},
                                            [](lab::Setup& s) {
                                              s.cell = 0.033;
                                              s.soil.bank_density = 1460;
                                              s.soil.friction_angle = radians(38);
                                              s.soil.tool_friction_angle = radians(26.6);
                                            });
    return lab::measured(report, "horizontal force");
  };
  const double whole = force(kUsualCourant);
  expect_between("raked blade in sand, 60 deg: force at half the step / at the step",
                 force(kHalfCourant) / whole, 0.97, 1.03, kStep);
}

TEST(ToolSpread, IsSmallForABucketsDragOverSteps) {
  const auto drag = [](double courant) {
    const lab::Report report = lab::run_rig("bucket", {{"courant", courant}});
    return lab::measured(report, "mean horizontal force of the drag");
  };
  const double force = drag(kUsualCourant);
  expect_between("bucket's drag in sand: force at half the step / at the step",
                 drag(kHalfCourant) / force, 0.97, 1.03, kStep);
}

}  // namespace
}  // namespace navvy::validation
