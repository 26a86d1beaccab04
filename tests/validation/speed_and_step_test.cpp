// SPDX-License-Identifier: Apache-2.0
// Forces at several speeds and two steps each: one that depends on either has no value. A miss fails unless it is in
// gates/known_misses.md.
#include <algorithm>
#include <string>
#include <vector>

#include "validation/rig_case.h"

namespace navvy::validation {
namespace {

const char* const kSource = "[Rankine 1857] [docs/validation.md, Blades and earth pressure]";
const char* const kStep = "the step [docs/validation.md, speed and step]";

double blade(double cell, double speed, double courant) {
  const lab::Report report = lab::run_rig("blade", {{"speed", speed}, {"courant", courant}, {"gate-percent", 0}},
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

TEST(ToolSpread, OfASmoothBladeOverSpeedsAndSteps) {
  std::vector<double> whole;
  double mean = 0, worst = 0;
  for (const double speed : {0.05, 0.15, 0.3}) {
    const double force = blade(0.05, speed, 0.5);
    whole.push_back(force);
    mean += force / 3;
    worst = std::max(worst, std::abs(blade(0.05, speed, 0.25) / force - 1));
  }
  expect_between("smooth blade, cells of 0.05 m, 0.05 .. 0.3 m/s: spread / mean", spread(whole), 0, 0.05, kSource);
  expect_between("smooth blade, cells of 0.05 m: mean force / Rankine", mean, 0.93, 1.07, kSource);
  expect_between("smooth blade, cells of 0.05 m: largest change at half the step", worst, 0, 0.01, kStep);
}

TEST(ToolSpread, OfASmoothBladeInCoarseCells) {
  std::vector<double> whole;
  double worst = 0;
  for (const double speed : {0.05, 0.15, 0.3}) {
    whole.push_back(blade(0.1, speed, 0.5));
    worst = std::max(worst, std::abs(blade(0.1, speed, 0.25) / whole.back() - 1));
  }
  expect_between("smooth blade, cells of 0.1 m, 0.05 .. 0.3 m/s: spread / mean", spread(whole), 0, 0.13, kSource);
  expect_between("smooth blade, cells of 0.1 m: largest change at half the step", worst, 0, 0.01, kStep);
  // Soil that a fast blade sets moving adds rho v^2 d w to Rankine's 2606 N: 1600 kg/m3, 0.3 m, 1 m.
  const double inertia = 1600 * 0.6 * 0.6 * 0.3 / 2606.4;
  expect_between("smooth blade, cells of 0.1 m, 0.6 m/s: force less rho v^2 d w / Rankine",
                 blade(0.1, 0.6, 0.5) - inertia, 0.95, 1.05, kSource);
}

TEST(ToolSpread, OfABucketsDragOverSteps) {
  const auto drag = [](double courant) {
    const lab::Report report = lab::run_rig("bucket", {{"courant", courant}});
    return lab::measured(report, "mean horizontal force of the drag");
  };
  const double force = drag(0.5);
  expect_between("bucket's drag in sand: force at half the step / at the step", drag(0.25) / force, 0.97, 1.03, kStep);
}

}  // namespace
}  // namespace navvy::validation
